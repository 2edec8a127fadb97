"""Lives in the factory of hidden customers and in buildings with days of hidden types, on equal tasks."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache

import numpy as np
from numpy.typing import NDArray

from benchmarks.agent.order_peers import PEERS
from lifelore.agent.long_lived.families.building_days import BuildingFamily
from lifelore.agent.long_lived.families.factory_customers import FactoryFamily
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import LivingSettings, live_task
from lifelore.agent.long_lived.task_family import AGENTS, TaskFamily
from lifelore.domains.buildings.building import building_from_map
from lifelore.domains.buildings.building_days import DAYS, BuildingDays
from lifelore.domains.buildings.occupancy_map import read_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.factory.customer_orders import CUSTOMERS
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.task_stream import TaskStream

Array = NDArray[np.float64]

SCRATCH = "scratch"
AGENT_NAMES = ("full", "no-prior", "no-reuse", SCRATCH)
"""The agent and its ablations; without relations in these worlds, perception is not ablated."""


@dataclass(frozen=True)
class Case:
    """A world and its stream of tasks.

    Parameters
    ----------
    name : str
    family : callable
        The family of a life's number.
    n_tasks : int
        Of a life.
    n_episodes : int
        Of a task, for every agent and peer; the first counts.
    agents : tuple of str
        Names of agents or of peers.
    """

    name: str
    family: Callable[[int], TaskFamily]
    n_tasks: int
    n_episodes: int
    agents: tuple[str, ...] = AGENT_NAMES


@dataclass(eq=False)
class Life:
    """What an agent did in a life.

    missed : (n_tasks, n_episodes) float64
        Best possible return less the return of each episode.
    alarms : (n_tasks,) bool
        Whether no known type fitted; False for peers.
    """

    missed: Array
    alarms: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, np.bool_))


def cases(map: str | None = None, n_orders: int = 24, n_ways: int = 90) -> list[Case]:
    """The worlds; the factory also with a late type and a change of the usual types."""
    found = [
        Case("factory", _factory(), n_orders, 2, (*AGENT_NAMES, *PEERS)),
        Case("factory that changes", _factory(*_changes("drones", n_orders)), n_orders, 2, CHANGING),
        Case("office", _office, n_ways, 3),
    ]
    return found if map is None else [*found, Case("mapped building", _mapped(map), n_ways, 3)]


CHANGING = ("full", "no-prior", SCRATCH)
"""Agents that live where types arrive and change."""


def _changes(late: str, n_tasks: int) -> tuple[dict[str, int], tuple[int, ...]]:
    """A type that arrives after half of the tasks, and usual types dealt anew after three quarters."""
    return {late: n_tasks // 2}, (n_tasks * 3 // 4,)


def _factory(arrivals=None, changes=()) -> Callable[[int], TaskFamily]:
    def family(life: int) -> TaskFamily:
        types = tuple(CUSTOMERS)
        return FactoryFamily(TaskStream(types, life, len(types), arrivals=arrivals or {}, changes=changes), life)

    return family


def _office(life: int) -> BuildingFamily:
    return _building(building_from_map(office_map(life)), life)


def _mapped(path: str) -> Callable[[int], TaskFamily]:
    @cache
    def world() -> GridWorld:
        return building_from_map(read_occupancy_map(path))

    return lambda life: _building(world(), life)


def _building(world: GridWorld, life: int) -> BuildingFamily:
    types = tuple(DAYS)
    return BuildingFamily(BuildingDays(world, TaskStream(types, life, len(types)), life))


def best_returns(family: TaskFamily, n_tasks: int) -> Array:
    """(n_tasks,) the best possible returns."""
    return np.array([family.best_return(number) for number in range(n_tasks)])


def live(name: str, family: TaskFamily, best: Array, n_episodes: int) -> Life:
    """The life of an agent, or of a peer."""
    if name in PEERS:
        assert isinstance(family, FactoryFamily), "peers live in the factory"
        peer = PEERS[name]()
        found = [peer.live(family, number, n_episodes) for number in range(len(best))]
        return Life(best[:, None] - np.array(found), np.zeros(len(best), np.bool_))
    abilities, knowledge = AGENTS[name], Knowledge.empty(family)
    returns, alarms = [], []
    for number in range(len(best)):
        if not abilities.memory:
            knowledge = Knowledge.empty(family)
        drawn, task = family.meet(number, abilities)
        lived, _ = live_task(
            knowledge, drawn, task, abilities, LivingSettings(n_episodes=n_episodes), f"agent.{number}"
        )
        returns.append(lived.returns)
        alarms.append(lived.alarm)
    return Life(best[:, None] - np.array(returns), np.array(alarms))
