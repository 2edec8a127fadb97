"""`bench fleet`: its measures by hand, fleets of any kind of robot, kills, and the contract of the answer."""

import json

import numpy as np
import pytest
from PIL import Image

from benchmarks.fleet import fleet, fleet_processes
from benchmarks.fleet.fleet import bench_fleet, lived_in_rounds, rounds_to_competence
from benchmarks.fleet.fleet_audit import added_again, task_numbers, wrong_sums
from benchmarks.fleet.fleet_processes import killed_processes, processes_on
from benchmarks.fleet.fleet_robot import FleetTask, Robot, office, office_life
from lifelore.core.protocols import Record
from lifelore.memory import open_memory


def test_rounds_to_competence_by_hand():
    def curve(*refused):
        return np.array([(moves, 100) for moves in refused], float)

    assert rounds_to_competence(curve(100, 50, 10, 10, 10)) == 2
    assert rounds_to_competence(curve(100, 20, 4, 6, 90)) == 1  # 30 refused moves in three rounds
    assert rounds_to_competence(curve(0, 0, 0)) == 0
    assert rounds_to_competence(curve(100, 50, 40, 5, 0)) == 5


def weigh(memory, robot: str, seq: int, weights: list[int], taken: int | None = None) -> bool:
    record = Record("prior", "shared", 1, "add", np.arange(len(weights)), np.array(weights))
    return memory.contribute(robot, [record], process="p", seq=seq, task={"index": seq}, taken=taken)


def test_sums_and_numbers_are_those_of_the_contributions(tmp_path):
    with open_memory(tmp_path / "m.db") as memory:
        for seq in (2, 0, 1):
            weigh(memory, "rosie", seq, [1, 2, 3])
        weigh(memory, "karl", 0, [5])
        assert task_numbers(memory, "rosie") == [0, 1, 2]
        assert [task for task, _ in memory.history("rosie")] == [{"index": 2}, {"index": 0}, {"index": 1}]
        assert memory.recall("prior", "shared", 1).values.tolist() == [8, 6, 9]
        assert wrong_sums(memory) == 0
        with memory._store.writing() as conn:
            conn.execute("UPDATE lifelore_cells SET value = 7 WHERE slot = 1 AND lore > 0")
        assert wrong_sums(memory) == 1


def test_merging_again_adds_nothing_unless_there_is_something_new(tmp_path):
    with open_memory(tmp_path / "robot.db") as own, open_memory(tmp_path / "fleet.db") as shared:
        weigh(own, "rosie", 0, [1])
        shared.merge_from(own)
        assert added_again(tmp_path / "fleet.db", [tmp_path / "robot.db"]) == 0
        weigh(own, "rosie", 1, [1])
        assert added_again(tmp_path / "fleet.db", [tmp_path / "robot.db"]) == 2


def counting_life(robot: Robot, tasks: int, finished) -> None:
    """Another agent: refuses fewer moves, the more tasks the fleet has lived."""
    with open_memory(robot.memory) as memory:
        for _ in range(tasks):
            with memory.taken_task(robot.name, process="p") as number:
                known = memory.recall("prior", "shared", 1)
                refused = max(0, 90 - 10 * (int(known.values[0]) if known else 0))
                weigh(memory, robot.name, number, [1], taken=number)
            finished(FleetTask(number, refused, 100))


def test_a_round_knows_what_the_fleet_knew_before(monkeypatch):
    monkeypatch.setitem(fleet.LIVES, "office", counting_life)
    curve, (wrong, again) = lived_in_rounds(3, 0, 5)
    assert curve.tolist() == [[90, 100], [60, 100], [30, 100], [0, 100], [0, 100]]
    assert (wrong, again) == (0, 0)


def test_a_robot_lives_in_an_office(tmp_path):
    tasks = []
    robot = Robot(str(tmp_path / "m.db"), "rosie", 3, office(tmp_path, 0))
    office_life(robot, 6, tasks.append)
    assert [task.number for task in tasks] == list(range(6))
    assert tasks[0].refused == tasks[0].scratch > 0  # nothing is known yet
    assert [task.refused for task in tasks] != [task.scratch for task in tasks]


@pytest.mark.parametrize("place", ["SQLite", "PostgreSQL"])
def test_processes_share_a_memory(place, monkeypatch):
    monkeypatch.setattr(fleet_processes, "PROCESSES", 2)
    monkeypatch.setattr(fleet_processes, "PROCESS_TASKS", 3)
    found = processes_on(place)
    assert found == {"robots": 2, "tasks": [[0, 1, 2]] * 2, "failed": 0, "problems": [], "wrong_sums": 0}


def test_kills_lose_only_tasks_in_progress(monkeypatch):
    monkeypatch.setattr(fleet_processes, "KILLS", 3)
    monkeypatch.setattr(fleet_processes, "KILL_PROCESSES", 2)
    found = killed_processes()
    assert found["kills"] == 5
    assert found["tasks"] > 5
    assert found["lost"] <= found["kills"]
    assert (found["twice"], found["missing"], found["problems"], found["wrong_sums"]) == (0, 0, [], 0)


def test_the_answer_keeps_its_contract(monkeypatch, tmp_path):
    monkeypatch.setattr(fleet, "ROUNDS", {1: 4, 2: 3})
    stored = {"robots": 4, "tasks": [list(range(8))] * 4, "failed": 0, "problems": [], "wrong_sums": 0}
    places = {"SQLite": stored, "PostgreSQL": None}
    monkeypatch.setattr(fleet, "processes_on", places.get)
    kills = {"kills": 5, "tasks": 9, "twice": 0, "lost": 2, "missing": 0, "problems": [], "wrong_sums": 1}
    monkeypatch.setattr(fleet, "killed_processes", lambda: kills)
    told = []
    result = bench_fleet(3, lambda *at: told.append(at), tmp_path)
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    assert [(done, of) for done, of, _ in told][-1] == (9, 9)
    assert set(result["rounds"]) == {"1", "2"}
    assert len(result["rounds"]["1"]) == 4
    names = [line["name"] for line in result["rows"]]
    assert len(names) == len(set(names))
    assert list(result["processes"]) == ["SQLite"]
    met = {goal["name"]: goal["met"] for goal in result["goals"]}
    assert met["4 processes on SQLite: failures, missing tasks, wrong sums"]
    assert met["tasks stored a kill"]
    assert met["tasks not yet taken again, a kill"]
    assert not met["after kills: tasks twice or missing, problems, wrong sums"]
    with Image.open(tmp_path / "bench_fleet.png") as picture:
        assert min(picture.size) > 300
