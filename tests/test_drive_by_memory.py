"""The py_trees behaviour drives a simulated robot by the way of memory, and memory learns from each drive."""

import importlib
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("py_trees", reason="needs py_trees (pip install py_trees)")

from py_trees.common import Status

from lifelore.agent.learn_from.learn_from import learn_from
from lifelore.agent.learn_from.run_log import GOAL, Run
from lifelore.domains.buildings.occupancy_map import write_occupancy_map
from lifelore.memory import open_memory

START, END = (1.25, 1.25), (4.75, 2.75)


class Robot:
    """Follows poses, 5 cm a tick at 0.5 m/s; may stop in front of an obstacle after some ticks."""

    def __init__(self, obstacle_after: int | None = None) -> None:
        self.clock, self.at, self.poses, self.k = 1.7e9, (*START, 0.0), None, 0
        self.obstacle_after, self.stopped = obstacle_after, False

    def follow(self, poses: np.ndarray) -> None:
        self.poses, self.k = poses, 0

    def pose(self) -> tuple[float, float, float, float]:
        if self.poses is not None and self.k < len(self.poses):
            self.at, self.k = tuple(map(float, self.poses[self.k])), self.k + 1
            self.clock += 0.1
        return (self.clock, *self.at)

    def outcome(self) -> str | None:
        if self.obstacle_after is not None and self.k >= self.obstacle_after:
            return "bump"
        return "goal" if self.k == len(self.poses) else None

    def stop(self) -> None:
        self.stopped = True


@pytest.fixture
def module(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "examples" / "ros2"))
    return importlib.import_module("drive_by_memory")


@pytest.fixture
def known(tmp_path: Path) -> tuple[str, str]:
    """A room of 6 x 4 m, and a memory that has driven through it from START to END."""
    state = np.zeros((82, 122), np.uint8)
    state[1:-1, 1:-1] = 254
    write_occupancy_map(tmp_path / "map.yaml", state, 0.05)
    map, memory = str(tmp_path / "map.yaml"), str(tmp_path / "m.db")
    corners = np.array([START, (4.75, 1.25), END])
    points = np.concatenate([np.linspace(a, b, 60) for a, b in pairwise(corners)])
    run = Run("first", 1.6e9 + 0.1 * np.arange(120), points, np.full(120, np.nan), [""] * 119 + [GOAL])
    learn_from([run], map=map, memory=memory)
    return map, memory


def ticked(behaviour: Any) -> Status:
    for _ in range(500):
        behaviour.tick_once()
        if behaviour.status != Status.RUNNING:
            break
    return behaviour.status


def drives(memory: str, robot: str = "robot") -> dict[str, dict]:
    """The drives that memory has learnt from, by name."""
    with open_memory(memory) as opened:
        return {one["run"]: one for one in opened.task_descriptions(robot) if "run" in one}


def ends() -> dict[str, str]:
    return {"start": f"{START[0]},{START[1]}", "goal": f"{END[0]},{END[1]}"}


def test_a_drive_to_the_goal_succeeds_and_is_learnt(module, known):
    map, memory = known
    robot = Robot()
    behaviour = module.DriveByMemory("to the end", robot, map=map, memory=memory, robot="rosie", **ends())
    behaviour.setup()
    assert ticked(behaviour) == Status.SUCCESS
    assert robot.at[:2] == pytest.approx(END)
    assert not robot.stopped
    assert drives(memory, "rosie")["to the end"]["goal"] is not None
    # It can be ticked again: another drive, from where the robot is.
    again = module.DriveByMemory("back", robot, goal=ends()["start"], map=map, memory=memory, robot="rosie")
    assert ticked(again) == Status.SUCCESS
    assert robot.at[:2] == pytest.approx(START)
    assert set(drives(memory, "rosie")) == {"to the end", "back"}


def test_a_drive_that_is_refused_fails_and_is_learnt(module, known):
    map, memory = known
    behaviour = module.DriveByMemory("refused", Robot(obstacle_after=30), map=map, memory=memory, **ends())
    assert ticked(behaviour) == Status.FAILURE
    assert behaviour.feedback_message == "the drive ended with: bump"
    assert drives(memory)["refused"]["goal"] is None


def test_a_drive_that_the_tree_gives_up_is_stopped_and_learnt(module, known):
    map, memory = known
    robot = Robot()
    behaviour = module.DriveByMemory("given up", robot, map=map, memory=memory, **ends())
    for _ in range(20):
        behaviour.tick_once()
    behaviour.stop(Status.INVALID)
    assert robot.stopped
    assert drives(memory)["given up"]["goal"] is None
    before = drives(memory)
    behaviour.stop(Status.INVALID)
    assert drives(memory) == before


def test_without_a_known_way_it_fails_in_the_words_of_lifelore(module, known):
    map, memory = known
    behaviour = module.DriveByMemory("nowhere", Robot(), map=map, memory=memory, goal="kitchen")
    assert ticked(behaviour) == Status.FAILURE
    assert "no destination of this building is named 'kitchen'" in behaviour.feedback_message
    with pytest.raises(ValueError, match="map"):
        module.DriveByMemory("no map", Robot(), map="none.yaml", memory=memory, goal="lab").setup()
