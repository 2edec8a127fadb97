"""Probability that each move is refused now: a belief that refusals raise, passes lower and age brings back.

A place is blocked or open, and all moves into it are refused or not. A refusal is seen with probability
`REFUSED_IF_BLOCKED` or `REFUSED_IF_OPEN`. After a half-life without news, half of the difference from the base
rate is left. The base rate is the share of refusals, shrunk from the building to the hours of the place, so that a
door that is closed every night is expected to be closed at night and not by day.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.travel.edge_times import DAY, N_HOURS, hour_of, smoothed_hours, summed
from lifelore.agent.travel.passes import Passes
from lifelore.domains.grids.grid_world import GridWorld

REFUSED_IF_BLOCKED, REFUSED_IF_OPEN = 0.98, 0.1
BASE = 0.01
"""Share of refusals where nothing was observed; counts as `STRENGTH` observations."""
STRENGTH = 4.0
"""Observations of the base rate that each hour of a place has before any observation of its own."""
HALF_LIFE = 7.0
"""Days after which half of a belief about a blocked place is left."""
BASE_HALF_LIFE = 60.0
"""Days after which an observation counts half in a base rate."""
NEWEST = 16
"""Newest observations of a place that the belief reads; more costs time and changes little."""


class _Events(NamedTuple):
    """Observations of places, by place and time; all (n,): place, minute, whether the move was refused."""

    place: NDArray[np.int64]
    minute: NDArray[np.int64]
    refused: NDArray[np.bool_]


def blocked_probability(world: GridWorld, passes: Passes, clock: float) -> NDArray[np.float64]:
    """Probability (n_states, 4) that each move is refused at `clock`; 1 where the map has no move.

    Parameters
    ----------
    world : GridWorld
    passes : Passes
    clock : float
        Seconds since 1970 by the robot's clock.
    """
    minute = int(clock // 60)
    events = _events(world, passes)
    entered, place = np.unique(events.place, return_inverse=True)
    events = events._replace(place=place)
    base, unseen = _base_rates(events, len(entered), minute)
    surprise, seen = np.zeros(len(entered)), np.zeros(len(entered), np.int64)
    for rows in _newest_last(events):
        place, now = events.place[rows], events.minute[rows]
        left = surprise[place] * 0.5 ** ((now - seen[place]) / DAY / HALF_LIFE)
        expected = base[place, hour_of(now)]
        before = np.clip(expected + left, 1e-4, 1 - 1e-4)
        refused = events.refused[rows]
        if_blocked = before * np.where(refused, REFUSED_IF_BLOCKED, 1 - REFUSED_IF_BLOCKED)
        if_open = (1 - before) * np.where(refused, REFUSED_IF_OPEN, 1 - REFUSED_IF_OPEN)
        surprise[place], seen[place] = if_blocked / (if_blocked + if_open) - expected, now
    left = surprise * 0.5 ** (np.maximum(minute - seen, 0) / DAY / HALF_LIFE)
    blocked = np.full(world.n_states, unseen)
    blocked[entered] = np.clip(base[:, int(hour_of(np.array(minute)))] + left, 0.0, 1.0)
    return np.where(world.neighbour >= 0, blocked[world.neighbour], 1.0)


def _events(world: GridWorld, passes: Passes) -> _Events:
    """Refusals and passes by place and time; those of one minute count once, refusals first."""
    # One number an event: place, minute, 1 for a pass. Their order is that of the events.
    number = (world.neighbour.ravel()[passes.move].astype(np.int64) << 27) | (passes.minute << 1)
    events = np.sort(np.concatenate([number[passes.refusals > 0], number[passes.passes > 0] | 1]))
    events = events[np.diff(events, prepend=-1) > 0]
    return _Events(events >> 27, events >> 1 & (2**26 - 1), events & 1 == 0)


def _base_rates(events: _Events, n: int, minute: int) -> tuple[NDArray[np.float64], float]:
    """Share of refusals by hour at each of `n` places, (n, 48), and at a place where nothing was observed."""
    weight = 0.5 ** (np.maximum(minute - events.minute, 0) / DAY / BASE_HALF_LIFE)
    slot, shape = events.place * N_HOURS + hour_of(events.minute), (n, N_HOURS)
    refused, every = summed(slot, weight * events.refused, shape), summed(slot, weight, shape)
    building = (STRENGTH * BASE + refused.sum()) / (STRENGTH + every.sum())
    return (STRENGTH * building + smoothed_hours(refused)) / (STRENGTH + smoothed_hours(every)), float(building)


def _newest_last(events: _Events) -> list[NDArray[np.int64]]:
    """Rows of `events`: of each place the earliest of its newest ones, then the next, to the newest."""
    last = np.flatnonzero(np.diff(events.place, append=-1))
    behind = np.repeat(last, np.diff(last, prepend=-1)) - np.arange(len(events.place))
    return [rows for age in range(NEWEST - 1, -1, -1) if len(rows := np.flatnonzero(behind == age))]
