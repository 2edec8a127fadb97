"""Drives a job whose goal is known.

until the robot is at the goal:
    plan      the route of least expected seconds, without the places that were refused in this drive
    drive     along it until it ends, or the building refuses a move
    observe   the seconds of each move, and the refusal
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.live.driven.drive import Drive
from lifelore.agent.live.driven.route import Route, RoutePlanner
from lifelore.domains.grids.grid_world import GridWorld

REFUSAL = 10.0
"""Seconds that a refused move costs a robot: to stop, to wait, and to plan again."""

Expected = Callable[[float], NDArray[np.float64]]
"""Clock to (n_states, 4) seconds to plan with; inf where the map has no move."""
Building = Callable[[NDArray, NDArray, NDArray], NDArray[np.float64]]
"""States, actions and clocks (n,) of moves to their seconds (n,); NaN for a refused move."""
Observe = Callable[[NDArray, NDArray, NDArray, NDArray], None]
"""Told states, actions, clocks and seconds (n,) of moves; seconds are NaN for a refused move."""


def drive_job(
    world: GridWorld,
    planner: RoutePlanner,
    start: int,
    goal: int,
    clock: float,
    expected: Expected,
    building: Building,
    observe: Observe,
) -> Drive:
    """Drive from a start to a goal, both states of `world`, at a `clock` in seconds since 1970."""
    began, place, legs = clock, start, []
    metres, moves, refusals = 0.0, 0, 0
    blocked: list[int] = []
    while place != goal:
        seconds = np.where(np.isin(world.neighbour, blocked), np.inf, expected(clock))
        route = planner.route(place, goal, seconds)
        if route is None:
            break
        clocks, took = _driven(route, clock, seconds, building)
        made, tried = int(np.isfinite(took).sum()), len(took)
        observe(route.states[:tried], route.actions[:tried], clocks, took)
        legs.append(route.states[: made + 1] if made < tried else np.append(route.states, goal))
        lengths = route.lengths[:made]
        metres, moves = metres + float(lengths.sum()) * world.frame.cell, moves + made
        clock += float(lengths @ took[:made])
        if made == tried:
            place = goal
        else:
            refusals, clock = refusals + 1, clock + REFUSAL
            place = int(route.states[made])
            blocked.append(int(world.neighbour[place, route.actions[made]]))
    return Drive(place == goal, metres, clock - began, refusals, max(len(legs) - 1, 0), moves, legs)


def _driven(
    route: Route, clock: float, expected: NDArray[np.float64], building: Building
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Clock and seconds of each move of a route, up to the first refused one."""
    took = building(route.states, route.actions, _clocks(clock, route, expected[route.states, route.actions]))
    clocks = _clocks(clock, route, np.nan_to_num(took))
    refused = np.flatnonzero(np.isnan(took))
    end = int(refused[0]) + 1 if len(refused) else len(took)
    return clocks[:end], took[:end]


def _clocks(clock: float, route: Route, seconds: NDArray[np.float64]) -> NDArray[np.float64]:
    """The clock at the start of each move, if the moves take these seconds."""
    return clock + np.concatenate([[0.0], (route.lengths * seconds).cumsum()[:-1]])
