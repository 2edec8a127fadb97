"""A life with goals of its user's own, and the names that memory knows afterwards."""

import csv
import json
import sqlite3
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.live.buildings.building_memory import forget_building
from lifelore.agent.live.goals.destinations import Destination, NamedPlaces, destination_from_text
from lifelore.agent.live.goals.job_list import Job
from lifelore.agent.live.life import Life, live
from lifelore.agent.live.output.report import FILES, write_portfolio
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Record
from lifelore.domains.buildings.occupancy_map import OccupancyMap, write_occupancy_map
from lifelore.memory import open_memory

from ..flat_settings import flat_settings

DOCK, LAB = (0.55, 0.55), (5.05, 3.05)


@pytest.fixture
def room(tmp_path: Path) -> str:
    """A room of 6 x 4 m."""
    state = np.zeros((42, 62), np.uint8)
    state[[0, -1], :] = state[:, [0, -1]] = 1
    write_occupancy_map(tmp_path / "room.yaml", OccupancyMap(state, 0.1))
    return str(tmp_path / "room.yaml")


def life_in(room: str, **changes) -> Life:
    memory = str(Path(room).parent / "life.db")
    return live(flat_settings(domain="building", map=room, memory=memory, **{"tasks": 2} | changes))


def jobs(*ends: Destination) -> tuple[Job, ...]:
    return tuple(Job(end, None, line) for line, end in enumerate(ends, start=2))


def test_one_goal_for_every_task_from_one_start(room):
    life = life_in(room, goal=LAB, start=DOCK)
    tasks = life.report["tasks"]
    assert [task["position"] for task in tasks] == [list(LAB)] * 2
    assert {tuple(task["goal"]) for task in tasks} == {(2, 10)}
    assert "name" not in tasks[0]
    assert life.start == life.world.state_of[7, 1]
    assert life.report["settings"]["goal"] == LAB
    assert life.report["settings"]["start"] == DOCK


def test_a_job_list_is_lived_in_order_and_its_names_are_known_later(room):
    list_of_jobs = jobs(Destination(LAB, "lab"), Destination(DOCK, "dock"), Destination(name="lab"))
    life = life_in(room, goals=list_of_jobs)
    tasks = life.report["tasks"]
    assert [task["name"] for task in tasks] == ["lab", "dock", "lab"]
    assert [task["goal"] for task in tasks] == [[2, 10], [7, 1], [2, 10]]
    assert life.report["settings"]["tasks"] == life.report["settings"]["goals"] == 3
    with open_memory(Path(room).parent / "life.db") as memory:
        names = NamedPlaces(memory.keys("building")[0][0])
        assert names.names(memory) == ["dock", "lab"]
        assert names.located("to", Destination(name="dock"), memory) == Destination(DOCK, "dock")
        with pytest.raises(NotFoundError, match="to: no destination of this building is named 'cellar'; memory"):
            names.located("to", Destination(name="cellar"), memory)
    with sqlite3.connect(Path(room).parent / "life.db") as file:
        about = [json.loads(row[0]) for row in file.execute("SELECT task FROM lifelore_contributions")]
    file.close()
    assert [(task["name"], task["position"]) for task in about] == [
        ("lab", list(LAB)), ("dock", list(DOCK)), ("lab", list(LAB))
    ]  # fmt: skip
    later = life_in(room, goal="dock", start="lab", tasks=1).report["tasks"][0]
    assert (later["name"], later["position"]) == ("dock", list(DOCK))


@pytest.mark.slow
def test_the_folder_of_a_building_has_clear_paths_to_the_point_and_masks(room, tmp_path):
    life = life_in(room, goals=jobs(Destination(LAB, "lab"), Destination(DOCK)))
    written = write_portfolio(life, str(tmp_path / "out"))
    assert [Path(path).name for path in written] == [name for name in FILES if name != "prior.png"]
    with (tmp_path / "out" / "paths.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    paths: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for row in rows:
        paths.setdefault((row["task"], row["path"]), []).append((float(row["x"]), float(row["y"])))
    assert set(paths) == {("0", "0"), ("1", "0")}
    for (task, _), points in paths.items():
        assert points[-1] == (LAB if task == "0" else DOCK)
        assert all(0.3 <= x <= 5.9 and 0.3 <= y <= 3.9 for x, y in points)


def test_a_name_that_moves_is_a_question(room):
    life_in(room, goals=jobs(Destination(LAB, "lab")))
    words = r"goals line 2: memory knows 'lab' at 5.05,3.05, 5.15 m from 0.55,0.55; .* --set move_names=true"
    with pytest.raises(InputError, match=words):
        life_in(room, goals=jobs(Destination(DOCK, "lab")))
    assert life_in(room, goal="lab", tasks=1).report["tasks"][0]["position"] == list(LAB)
    life_in(room, goals=jobs(Destination(DOCK, "lab")), move_names=True)
    assert life_in(room, goal="lab", tasks=1).report["tasks"][0]["position"] == list(DOCK)


def test_a_name_within_a_cell_of_its_place_is_no_question(room):
    life_in(room, goals=jobs(Destination(LAB, "lab")))
    near = (LAB[0] - 0.3, LAB[1] - 0.3)
    assert life_in(room, goals=jobs(Destination(near, "lab"))).report["tasks"][0]["position"] == list(near)


def test_names_belong_to_their_building(room, tmp_path):
    life_in(room, goals=jobs(Destination(LAB, "lab")))
    assert life_in(room, goal="lab", cell=0.25, tasks=1).report["tasks"][0]["position"] == list(LAB)
    hall = np.pad(np.zeros((20, 80), np.uint8), 1, constant_values=1)
    write_occupancy_map(tmp_path / "hall.yaml", OccupancyMap(hall, 0.1))
    with pytest.raises(NotFoundError, match="memory knows no names here"):
        life_in(str(tmp_path / "hall.yaml"), goal="lab")


def test_names_are_forgotten_with_their_building(room):
    life_in(room, goals=jobs(Destination(LAB, "lab"), Destination(DOCK, "dock")))
    with open_memory(Path(room).parent / "life.db") as memory:
        names = NamedPlaces(memory.keys("building")[0][0])
        assert names.names(memory) == ["dock", "lab"]
        passes = Record("passes", "any", 1, "add", np.array([5]), np.array([1]), {"building": names.key})
        memory.contribute("robot", [passes], process="drive", seq=0, task={})
        forget_building(memory, "room")
        assert names.names(memory) == []
        assert memory.keys("destination") == memory.keys("robot_clock") == memory.keys("passes") == []


def test_names_move_with_a_map_that_was_saved_again():
    """A quarter turn and a shift: the same spot of the floor has other coordinates."""
    first, later = NamedPlaces("b"), NamedPlaces("b", (1.0, 2.0, np.pi / 2))
    record = later.record("dock", (3.0, 4.0))
    # Turned a quarter to the left and shifted: (-4 + 1, 3 + 2).
    assert record.values.tolist() == [-3_000_000, 5_000_000]
    assert first.record("dock", (-3.0, 5.0)).values.tolist() == record.values.tolist()


def test_tasks_without_chosen_goals_are_as_before(room):
    """A goal that the user chooses draws nothing: the random streams of other tasks stay."""
    drawn = life_in(room, robot="a").report["tasks"]
    assert all(set(task) == {"index", "goal", "how", "optimal_return", "agents"} for task in drawn)
    assert {task["how"] for task in drawn} == {"searched"}


@pytest.mark.parametrize(
    ("changes", "error", "words"),
    [
        ({"goal": (0.1, 0.1)}, InputError, "goal must be a free place"),
        ({"start": (99.0, 0.5)}, InputError, "start must be a free place"),
        (
            {"goals": jobs(Destination(LAB), Destination((0.0, 0.0)))},
            InputError,
            "goals line 3 must be a free place",
        ),
        ({"goals": jobs(Destination(name="attic"))}, NotFoundError, "goals line 2: no destination"),
        ({"goal": LAB, "start": LAB}, InputError, "goal must lie in another cell than start"),
        (
            {"goals": jobs(Destination((0.0, 0.0)), Destination(LAB), Destination(name="attic"))},
            InputError,
            "goals line 2 must be a free place.*; goals line 4: no destination",
        ),
    ],
)
def test_places_that_break_a_rule_are_found_before_the_first_task(room, changes, error, words):
    with pytest.raises(error, match=words):
        life_in(room, **changes)
    with open_memory(Path(room).parent / "life.db") as memory:
        assert memory.tasks("robot") == 0


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"goal": (1, 1), "destinations": 3, "domain": "lattice"}, "goal and destinations exclude each other"),
        ({"goal": (1.0, 1.0), "agent": "scratch"}, "agent applies to hidden goals"),
        ({"busy": True}, "busy applies to goals that are driven to"),
        ({"goal": (1.0, 1.0), "goals": jobs(Destination(LAB))}, "goal and goals exclude each other"),
        ({"goals": jobs(Destination(LAB)), "domain": "lattice"}, "goals needs a building"),
    ],
)
def test_settings_that_exclude_each_other(changes, words):
    with pytest.raises(InputError, match=words):
        flat_settings(**{"domain": "building"} | changes)


def test_cells_in_worlds_without_metres(tmp_path):
    memory = str(tmp_path / "life.db")
    tasks = live(flat_settings(tasks=2, goal=(3, 3), start=(1, 1), memory=memory)).report["tasks"]
    assert [task["goal"] for task in tasks] == [[3, 3], [3, 3]]
    assert "position" not in tasks[0]
    with pytest.raises(InputError, match=r"goal must be a free cell ROW,COL .* nearest free cell is 1,1"):
        live(flat_settings(goal=(0, 0), memory=memory))
    with pytest.raises(InputError, match="start must be ROW,COL in domain 'lattice', got 'dock'"):
        live(flat_settings(start="dock", memory=memory))


@pytest.mark.parametrize(
    ("text", "end"),
    [
        ("1,2", Destination((1.0, 2.0))),
        (" -1.5 , 2e1 ", Destination((-1.5, 20.0))),
        ("dock 2", Destination(name="dock 2")),
    ],
)
def test_places_from_text(text, end):
    assert destination_from_text("to", text) == end


@pytest.mark.parametrize("text", ["1,", "1,2,3", "a,b", "", "  ", "nan,1", "1,inf"])
def test_text_that_is_no_place(text):
    with pytest.raises(InputError):
        destination_from_text("to", text)
