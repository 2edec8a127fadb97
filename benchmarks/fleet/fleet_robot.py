"""A robot of a fleet as one function, and as a program that runs the function in a process of its own.

A robot is a `RobotLife`; another agent joins the benchmarks as another function of this type, see `LIVES`.
"""

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LearningSettings, LifeSettings, MemorySettings
from lifelore.agent.live.task_result import TaskResult
from lifelore.agent.long_lived.families.factory_customers import FactoryFamily
from lifelore.agent.long_lived.live_task import LivingSettings
from lifelore.agent.long_lived.long_life import LongLifeSettings, live_long
from lifelore.domains.buildings.occupancy_map import write_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.factory.customer_orders import CUSTOMERS, CustomerOrder
from lifelore.domains.task_stream import DrawnTask, TaskStream
from lifelore.domains.worlds import WorldSettings

MOVES = 500
"""Moves of a task: one episode, so that a single task cannot show the whole building."""
EPISODES = 2
"""Episodes of an order."""
CUSTOMERS_LIFE = "factory-customers"
MOST_ROBOTS = 100
"""Robots whose orders differ: more share some."""


class Robot(NamedTuple):
    """A robot in a world.

    memory : file or URL
    name : of the robot in memory
    seed : draws its tasks
    world : YAML of a ROS map; of orders, the number of the stream of customers
    """

    memory: str
    name: str
    seed: int
    world: str


class FleetTask(NamedTuple):
    """A finished task: its number, and the refused moves of the robot and of one that knows nothing.

    Of an order: the points that its first episode missed, and 0.
    """

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


@dataclass(frozen=True)
class RobotOrders(FactoryFamily):
    """Orders of one robot of a fleet: all have the same customers and contexts, and no two the same order.

    Parameters
    ----------
    robot : int
        Number of the robot, below `MOST_ROBOTS`.
    """

    robot: int = 0

    def order(self, number: int, context: int | None = None, episode: int = 0) -> tuple[DrawnTask, CustomerOrder]:
        """Order `number` of the robot."""
        drawn, order = super().order(number * MOST_ROBOTS + self.robot, context, episode)
        return DrawnTask(number, drawn.context, drawn.hidden_type), order


def robot_orders(world: str, robot: int) -> RobotOrders:
    """The orders of a robot, from the number of the stream of customers."""
    types = tuple(CUSTOMERS)
    return RobotOrders(TaskStream(types, int(world), len(types)), int(world), robot=robot)


def customers_life(robot: Robot, tasks: int, finished: Callable[[FleetTask], None]) -> None:
    """Tasks of the long-lived agent, which serves hidden customers: `lifelore live --refresh`."""

    def watch(task: dict) -> None:
        finished(FleetTask(task["task"], round(task["best_return"] - task["returns"][0]), 0))

    settings = LongLifeSettings(
        CUSTOMERS_LIFE,
        n_tasks=tasks,
        seed=robot.seed,
        robot=robot.name,
        memory=robot.memory,
        living=LivingSettings(n_episodes=EPISODES),
        refresh=True,
    )
    live_long(settings, watch=watch, family=robot_orders(robot.world, robot.seed % MOST_ROBOTS))


LIVES: dict[str, RobotLife] = {"office": office_life, CUSTOMERS_LIFE: customers_life}
LIFE = "office"


def office(folder: Path, building: int) -> str:
    """The map of a generated office, written to a folder."""
    write_occupancy_map(folder / "office.yaml", office_map(building))
    return str(folder / "office.yaml")


def world_of(life: str, folder: Path, number: int) -> str:
    """The world of robots of a life, as `Robot.world` names it; a file of it is written to the folder."""
    return office(folder, number) if life == LIFE else str(number)


def command(robot: Robot, tasks: int, life: str = LIFE) -> list[str]:
    """The command line that lives so many tasks and prints a line for each."""
    arguments = [life, robot.memory, robot.name, str(robot.seed), robot.world, str(tasks)]
    return [sys.executable, "-m", "benchmarks.fleet.fleet_robot", *arguments]


def _print(task: FleetTask) -> None:
    print(json.dumps(task), flush=True)


if __name__ == "__main__":
    which, where, name, seed, world, tasks = sys.argv[1:]
    LIVES[which](Robot(where, name, int(seed), world), int(tasks), _print)
