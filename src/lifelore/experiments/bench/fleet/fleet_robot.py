"""A robot of a fleet as one function, and as a program that runs the function in a process of its own.

A robot is a `RobotLife`; another agent joins the benchmark as another function of this type, see `LIVES`.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LearningSettings, LifeSettings, MemorySettings
from lifelore.agent.live.task_result import TaskResult
from lifelore.domains.buildings.occupancy_map import write_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.worlds import WorldSettings

MOVES = 500
"""Moves of a task: one episode, so that a single task cannot show the whole building."""


class Robot(NamedTuple):
    """A robot in a world.

    memory : file or URL
    name : of the robot in memory
    seed : draws its tasks
    world : YAML of a ROS map
    """

    memory: str
    name: str
    seed: int
    world: str


class FleetTask(NamedTuple):
    """A finished task: its number, and the refused moves of the robot and of one that knows nothing."""

    number: int
    refused: int
    scratch: int


RobotLife = Callable[[Robot, int, Callable[[FleetTask], None]], None]
"""``life(robot, tasks, finished)`` lives so many tasks and calls `finished` after memory has stored each."""


def office_life(robot: Robot, tasks: int, finished: Callable[[FleetTask], None]) -> None:
    """Tasks of `lifelore live` in a building that the robot does not know, `MOVES` moves each."""

    def watch(task: dict, results: dict[str, TaskResult]) -> None:
        finished(FleetTask(task["index"], results["lore"].collisions, results["scratch"].collisions))

    settings = LifeSettings(
        WorldSettings("building", robot.world, seed=robot.seed),
        LearningSettings(episodes=1, max_steps=MOVES),
        memory=MemorySettings(robot.memory, robot.name, refresh=True),
        tasks=tasks,
        jobs=1,
    )
    live(settings, watch=watch)


LIVES: dict[str, RobotLife] = {"office": office_life}
LIFE = "office"


def office(folder: Path, building: int) -> str:
    """The map of a generated office, written to a folder."""
    write_occupancy_map(folder / "office.yaml", office_map(building))
    return str(folder / "office.yaml")


def command(robot: Robot, tasks: int, life: str = LIFE) -> list[str]:
    """The command line that lives so many tasks and prints a line for each."""
    arguments = [life, robot.memory, robot.name, str(robot.seed), robot.world, str(tasks)]
    return [sys.executable, "-m", "lifelore.experiments.bench.fleet.fleet_robot", *arguments]


def _print(task: FleetTask) -> None:
    print(json.dumps(task), flush=True)


if __name__ == "__main__":
    which, where, name, seed, world, tasks = sys.argv[1:]
    LIVES[which](Robot(where, name, int(seed), world), int(tasks), _print)
