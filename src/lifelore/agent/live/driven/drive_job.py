"""Drives a job whose goal is known.

until the robot is at the goal:
    plan      the route of least expected seconds, without the places that were refused in this drive
    drive     along it until it ends, or the building refuses a move
    observe   the seconds of each move, and the refusal
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.live.driven.route import cheapest_route
from lifelore.domains.buildings.busy_building import REFUSED_SECONDS, Drive
from lifelore.domains.grids.grid_world import GridWorld

DOUBT = 10.0
"""Seconds that are added in a drive to a move into a place beside a refused one: what blocks is often wider."""

Expected = Callable[[float], NDArray[np.float64]]
"""Clock to (n_states, 4) seconds to plan with; inf where the map has no move."""
Building = Callable[[NDArray[np.int64], float], Drive]
"""States of a way and the clock at its start to what a robot observes on it, up to the first refused move."""
Observe = Callable[[NDArray, NDArray, NDArray, NDArray], None]
"""Called with states, actions, clocks and seconds (n,) of moves; a refused move has NaN seconds."""


@dataclass
class DrivenJob:
    """The drive to a known goal.

    reached : whether the robot arrived; otherwise no way was left
    metres : driven, along moves and diagonal steps
    seconds : from the start to the arrival, or until no way was left
    refusals : moves that the building refused
    replans : routes that were planned after the first one
    moves : number of moves made
    legs : the states passed, a list for each route, each from its start on
    """

    reached: bool
    metres: float
    seconds: float
    refusals: int
    replans: int
    moves: int
    legs: list[NDArray[np.int64]] = field(repr=False)

    def paths(self) -> list[NDArray[np.int32]]:
        """All states passed, as one path; none if the robot stood at the goal."""
        if not self.legs:
            return []
        return [np.concatenate([leg[:-1] for leg in self.legs] + [self.legs[-1][-1:]]).astype(np.int32)]

    def drop_arrays(self) -> None:
        """Drop the states passed."""
        self.legs = []

    def episodes(self) -> dict[str, NDArray]:
        """A drive has no episodes."""
        return {}

    def to_dict(self) -> dict:
        """The numbers as JSON data."""
        return {
            "reached": self.reached,
            "metres": round(self.metres, 3),
            "seconds": round(self.seconds, 3),
            "refusals": self.refusals,
            "replans": self.replans,
        }


def drive_job(
    world: GridWorld,
    start: int,
    goal: int,
    clock: float,
    expected: Expected,
    building: Building,
    observe: Observe,
) -> DrivenJob:
    """Drive from a start to a goal, both states of `world`, at a `clock` in seconds since 1970."""
    began, place, legs = clock, start, []
    metres, moves, refusals = 0.0, 0, 0
    blocked: list[int] = []
    while place != goal:
        seconds = expected(clock) + _doubt(world, blocked)[world.neighbour]
        route = cheapest_route(world, place, goal, seconds)
        if route is None:
            break
        drive = building(route.states, clock)
        observe(drive.states, drive.actions, drive.clock, drive.seconds)
        refused = bool(np.isnan(drive.seconds[-1]))
        made = len(drive.seconds) - refused
        legs.append(route.states[: made + 1])
        lengths = route.lengths[:made]
        metres, moves = metres + float(lengths.sum()) * world.frame.cell, moves + made
        clock += float(lengths @ drive.seconds[:made]) + refused * REFUSED_SECONDS
        place = int(route.states[made])
        if refused:
            refusals += 1
            blocked.append(int(route.states[made + 1]))
    return DrivenJob(place == goal, metres, clock - began, refusals, max(len(legs) - 1, 0), moves, legs)


def _doubt(world: GridWorld, blocked: list[int]) -> NDArray[np.float64]:
    """Seconds to add to moves into each state: infinite for blocked ones, `DOUBT` beside them, else 0."""
    seconds = np.where(world.around(np.array(blocked, np.int64)), DOUBT, 0.0)
    seconds[blocked] = np.inf
    return seconds
