"""`bench customer_fleet`, small: robots with orders of their own, and the contract of the answer."""

import json

import numpy as np
import pytest

from benchmarks import BENCHES
from benchmarks.fleet import customer_fleet as case
from benchmarks.fleet.fleet_processes import processes_on
from benchmarks.fleet.fleet_robot import (
    CUSTOMERS_LIFE,
    LIVES,
    FleetTask,
    Robot,
    robot_orders,
)
from lifelore.memory import open_memory


def test_robots_have_the_same_customers_and_orders_of_their_own():
    ada, bob = robot_orders("3", 0), robot_orders("3", 1)
    assert ada.stream == bob.stream != robot_orders("4", 0).stream
    one, other = ada.order(5), bob.order(5)
    assert one[0].number == other[0].number == 5
    assert one[1].factory.procure_at.tolist() != other[1].factory.procure_at.tolist()


def test_competence_is_two_good_tests_in_a_row():
    def needed(*missed):
        return case.rounds_to_competence(np.array(missed, float), 40.0)

    assert needed(40, 20, 21, 20, 19) == 5
    assert needed(0, 0) == 2
    assert needed(40, 40, 10) == 3


@pytest.mark.slow
def test_a_robot_goes_on_and_recalls_the_fleet(tmp_path):
    where, lived = str(tmp_path / "m.db"), list[FleetTask]()
    for name, seed in (("ada", 0), ("bob", 1), ("ada", 0)):
        LIVES[CUSTOMERS_LIFE](Robot(where, name, seed, "3"), 1, lived.append)
    assert [task.number for task in lived] == [0, 0, 1]
    with open_memory(where) as memory:
        assert [memory.tasks(name) for name in ("ada", "bob")] == [2, 1]
        third = next(task for task in memory.task_descriptions("ada") if task["task"] == 1)
        assert {"ada.0", "bob.0"} & set("+".join(third["prior"]).split("+"))


@pytest.mark.slow
def test_rows_goals_and_places(monkeypatch, tmp_path):
    for name, value in {"ROUNDS": {1: 3, 2: 2}, "TESTS": 2, "LEAST_REPEATS": 1}.items():
        monkeypatch.setattr(case, name, value)
    stored = {"robots": 3, "tasks": [[0, 1, 2, 3]] * 3, "failed": 0, "problems": [], "wrong_sums": 0}
    kills = {"kills": 7, "tasks": 9, "twice": 0, "lost": 2, "missing": 0, "problems": [], "wrong_sums": 0}
    monkeypatch.setattr(case, "processes_on", lambda place, *more: stored)
    monkeypatch.setattr(case, "killed_processes", lambda place, *more: kills | {"twice": int(place == "SQLite")})
    steps = []
    result = case.bench_customer_fleet(1, lambda *at: steps.append(at[:2]), tmp_path)
    assert BENCHES["customer_fleet"] == "fleet"
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    assert steps == [(1, 6), (2, 6), (4, 6), (6, 6)]
    assert [len(result["rounds"][robots]) for robots in ("1", "2")] == [3, 2]
    met = {goal["name"]: goal["met"] for goal in result["goals"]}
    assert met["wrong sums, problems, differences between PostgreSQL and SQLite"]
    assert met["3 processes on SQLite: failures, missing tasks, wrong sums"]
    assert met["after kills on PostgreSQL: tasks twice or missing, problems, wrong sums"]
    assert not met["after kills on SQLite: tasks twice or missing, problems, wrong sums"]
    assert (tmp_path / "bench_customer_fleet.png").stat().st_size > 5000


@pytest.mark.slow
def test_processes_of_the_long_lived_agent_share_a_file():
    found = processes_on("SQLite", CUSTOMERS_LIFE, 2, 1)
    assert found == {"robots": 2, "tasks": [[0], [0]], "failed": 0, "problems": [], "wrong_sums": 0}
