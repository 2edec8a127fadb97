"""Days in a building: corridors that are blocked and crowds, by a hidden type of day; the map does not show them.

A type of day blocks the same passages and crowds the same places of a building whenever it comes. Every task is a
way from a start to a destination: a move costs `MOVE`, into a crowd `CROWD`, and a refused move `REFUSED`.
"""

from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csgraph

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.domains.buildings.busy_places import around, blocked_passages, move_graph, on_shortest_ways, without
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.task_stream import CountedTask, DrawnTask, TaskStream

MOVE, CROWD, REFUSED = -1.0, -6.0, -2.0
"""Points of a move, of a move into a crowd, and of a move that is refused."""
DAYS = MappingProxyType(
    {"quiet": (0, 0), "cleaning": (3, 0), "visitors": (0, 3), "meeting": (1, 2), "works": (6, 1)}
)
"""Types of day: number of blocked passages and of crowds."""
BLOCK_RADIUS, CROWD_RADIUS = 1, 3
"""Cells around the middle of a blocked passage, and of a crowd (larger coordinate difference)."""
LONGEST = 5000
"""Actions after which a way is cut."""


@dataclass(frozen=True, eq=False)
class Day:
    """What a type of day makes of a building: the moves that are open, and the crowded cells.

    Parameters
    ----------
    neighbour : (n_states, 4) int32
        As in `GridWorld`, with blocked moves -1. Cells that are blocked cannot be entered or left.
    crowded : (n_states,) bool
    open : (n_states,) bool
        Cells of the connected part that is left; at least nine in ten of all.
    """

    neighbour: NDArray[np.int32]
    crowded: NDArray[np.bool_]
    open: NDArray[np.bool_]


def day_in(world: GridWorld, day_type: str, seed: int = 0) -> Day:
    """The day of a type in a building; the same for the same arguments.

    Raises
    ------
    NotFoundError
        No day has this type.
    """
    if day_type not in DAYS:
        raise NotFoundError(f"type of day must be one of {', '.join(DAYS)}, got {day_type!r}")
    n_blocked, n_crowds = DAYS[day_type]
    rng = stream(seed, "building days", world.fingerprint, day_type)
    busy = on_shortest_ways(world, rng)
    passages = blocked_passages(world, rng, busy, n_blocked, BLOCK_RADIUS)
    opened = np.logical_not(np.logical_or.reduce(passages, axis=0))
    crowded = np.zeros(world.n_states, np.bool_)
    for middle in rng.choice(world.n_states, size=n_crowds, replace=False, p=busy):
        crowded |= around(world, int(middle), CROWD_RADIUS)
    return Day(without(world.neighbour, opened), crowded & opened, opened)


@dataclass(frozen=True)
class WayObservation:
    """The cell, the destination, and whether the last move was refused."""

    cell: int
    destination: int
    refused: bool = False


class BuildingWay(CountedTask):
    """One way on a day of a hidden type; the actions are moves north, south, east and west.

    Parameters
    ----------
    world : GridWorld
        The building by its map.
    day : Day
    start, destination : int
        Different open cells.
    """

    n_actions, longest = 4, LONGEST

    def __init__(self, world: GridWorld, day: Day, start: int, destination: int) -> None:
        if start == destination or not day.open[[start, destination]].all():
            raise InputError(f"start and destination must be different open cells, got {start} and {destination}")
        super().__init__(start)
        self.world, self._day, self.destination = world, day, destination

    @cached_property
    def best_return(self) -> float:
        """Largest return of an agent that knows the day; not discounted."""
        cost = np.where(self._day.crowded, -CROWD, -MOVE)
        graph = move_graph(self._day.neighbour, cost)
        return -float(csgraph.dijkstra(graph, indices=self.start)[self.destination])

    def _act(self, state: int, action: int) -> tuple[int, float, bool, bool]:
        target = int(self._day.neighbour[state, action])
        if target < 0:
            return state, REFUSED, False, True
        return target, CROWD if self._day.crowded[target] else MOVE, target == self.destination, False

    def _observed(self, state: int, refused: bool) -> WayObservation:
        return WayObservation(state, self.destination, refused)


@dataclass(frozen=True, eq=False)
class BuildingDays:
    """Ways by number in one building.

    Parameters
    ----------
    world : GridWorld
    stream : TaskStream
        Its types are keys of `DAYS`.
    seed : int
        Of blocked passages, crowds, starts and destinations.
    n_destinations : int
        Number of places that ways lead to, at least 1: most jobs recur.
    """

    world: GridWorld
    stream: TaskStream
    seed: int = 0
    n_destinations: int = 12

    @cached_property
    def _days(self) -> dict[str, Day]:
        return {name: day_in(self.world, name, self.seed) for name in self.stream.types}

    def task(self, number: int, context: int | None = None) -> tuple[DrawnTask, BuildingWay]:
        """Task `number` and its world, in a chosen context if given; the same for the same number."""
        drawn, days = self.stream.draw(number, context), self._days
        # Destinations are open on every day, so that days cannot be told apart by them.
        always = np.logical_and.reduce([day.open for day in days.values()])
        places = stream(self.seed, "building days", "destinations").permutation(np.flatnonzero(always))
        rng = stream(self.seed, "building days", "way", number)
        destination = int(places[int(rng.integers(self.n_destinations))])
        start = int(rng.choice(np.setdiff1d(places, [destination])))
        return drawn, BuildingWay(self.world, days[drawn.hidden_type], start, destination)
