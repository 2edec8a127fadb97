"""A building that does things to a robot: rush hours, slow corridors, places blocked for days, closed doors.

The seconds of a move are cell / speed, times the factor of the zone that it enters, times noise:

- *floor*: some zones are always slow (a ramp, a carpet);
- *rush*: some zones are slow twice a day at their own hours of weekdays;
- *drift*: some zones become slower and faster again over weeks;
- *noise*: whole drives and single moves are slower or faster, and now and then somebody stands in the way.

A move into a blocked cell is refused: some places are blocked for hours to days, at random; doors are closed every
night. All of it depends on the seed and the clock alone. The map shows nothing of it.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.buildings.busy_places import around, blocked_passages, on_shortest_ways
from lifelore.domains.grids.grid_world import GridWorld

MONDAY = 1_704_067_200.0
"""Start of the simulated calendar, Monday 2024-01-01 00:00, in seconds since 1970."""
HOUR, DAY = 3600.0, 86400.0
SPEED = 0.5
"""Metres a second on an empty floor."""
REFUSED_SECONDS = 5.0
"""Seconds until a robot gives up a refused move."""
N_FLOOR, N_RUSH, N_DRIFT, N_BLOCKED, N_DOORS = 6, 10, 8, 6, 2
"""Number of zones of each kind, of places that are blocked at times, and of doors."""
RUSH_HOURS, DRIFT_WEEKS = 3.0, 6.0
"""Hours of each of a zone's two rushes a day, and weeks from slow to slow in a zone that drifts."""
FACTORS = 1.5, 3.0
"""Least and largest factor of seconds in a zone; where zones overlap, the larger one counts."""
ZONE_M, PLACE_M = 2.0, 0.5
"""Metres from the middle of a zone, and of a blocked place or door, to its border."""
NIGHT = 20, 6
"""Hours from which and until which doors are closed."""
OPEN_DAYS, BLOCKED_DAYS = 10.0, 1.5
"""Mean days (exponential) for which a place is open, and blocked."""
DRIVE_NOISE, MOVE_NOISE = 0.08, 0.15
"""Standard deviations of log seconds, of whole drives and of moves."""
WAIT_CHANCE, WAIT_SECONDS = 0.005, 8.0
"""Probability a move that somebody stands in the way, and mean seconds (exponential) of the wait."""


class Drive(NamedTuple):
    """What a robot observes on a way; arrays (n,) for n moves. A refused move is the last.

    states : int, where each move began
    actions : int
    clock : float, seconds since 1970 when each move began
    seconds : float, of each move; NaN where it was refused
    end : float, seconds since 1970 when the drive ended
    """

    states: NDArray[np.int64]
    actions: NDArray[np.int64]
    clock: NDArray[np.float64]
    seconds: NDArray[np.float64]
    end: float


class _Zones(NamedTuple):
    """Squares of cells, n of them: kind (n,), cells (n, n_states) 0 or 1, log factor (n,), hours (2, n)."""

    kind: NDArray[np.str_]
    cells: NDArray[np.float64]
    size: NDArray[np.float64]
    hours: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BusyBuilding:
    """A building with zones and blocked places.

    Parameters
    ----------
    world : GridWorld
        The building by its map.
    seed : int
        Draws zones, hours, and spans of days.
    """

    world: GridWorld
    seed: int = 0

    def seconds(self, clock: float) -> NDArray[np.float64]:
        """Median seconds (n_states,) of a move into each cell at `clock`, if it is not refused."""
        kind, cells, size, start = self._zones
        hour, weekday = clock % DAY / HOUR, (clock - MONDAY) // DAY % 7 < 5
        rush = (kind == "rush") & weekday & ((hour - start) % 24 < RUSH_HOURS).any(axis=0)
        weeks = (clock - MONDAY) / (7 * DAY)
        drift = (kind == "drift") * (0.5 + 0.5 * np.sin(2 * np.pi * (weeks / DRIFT_WEEKS + start[0] / 10)))
        log_factor = size * np.where(kind == "floor", 1.0, rush + drift)
        return self.world.frame.cell / SPEED * np.exp((log_factor[:, None] * cells).max(axis=0))

    def blocked(self, clock: float) -> NDArray[np.bool_]:
        """Cells (n_states,) into which all moves are refused at `clock`."""
        passages, spans = self._passages
        hour = clock % DAY / HOUR
        # Passages begin open; each end of a span blocks or opens them. The last ones are doors.
        now = np.array([np.searchsorted(ends, clock, side="right") % 2 == 1 for ends in spans])
        now[-N_DOORS:] = hour >= NIGHT[0] or hour < NIGHT[1]
        return np.logical_or.reduce(passages[now], axis=0)

    @property
    def never_blocked(self) -> NDArray[np.bool_]:
        """Cells (n_states,) that no passage and no door can block."""
        return np.logical_not(np.logical_or.reduce(self._passages[0], axis=0))

    def drive(self, way: NDArray[np.int64], clock: float, rng: np.random.Generator) -> Drive:
        """Drive along `way` from `clock` on, to its end or to the first refused move.

        Parameters
        ----------
        way : (n + 1,) int
            At least two states, each one move away from the state before it.
        clock : float
            Seconds since 1970, not before `MONDAY`.
        rng : Generator
            Draws the noise.

        Raises
        ------
        InputError
            Two states of the way are not one move apart.
        """
        way = np.asarray(way, np.int64)
        apart, actions = np.nonzero(self.world.neighbour[way[:-1]] == way[1:, None])
        if len(way) < 2 or not np.array_equal(apart, np.arange(len(way) - 1)):
            raise InputError("way must be states that are one move apart, at least two; take the states of a path")
        n, pace = len(actions), DRIVE_NOISE * rng.standard_normal()
        noise = np.exp(pace + MOVE_NOISE * rng.standard_normal(n))
        waits = rng.exponential(WAIT_SECONDS, n) * (rng.random(n) < WAIT_CHANCE)
        clocks, taken = np.empty(n), np.full(n, np.nan)
        minute, seconds, blocked = clock // 60, self.seconds(clock), self.blocked(clock)
        for move, target in enumerate(way[1:].tolist()):
            if clock // 60 != minute:
                minute, seconds, blocked = clock // 60, self.seconds(clock), self.blocked(clock)
            clocks[move] = clock
            if blocked[target]:
                n = move + 1
                return Drive(way[:n], actions[:n], clocks[:n], taken[:n], clock + REFUSED_SECONDS)
            taken[move] = seconds[target] * noise[move] + waits[move]
            clock += taken[move]
        return Drive(way[:-1], actions, clocks, taken, clock)

    def _stream(self, purpose: str) -> np.random.Generator:
        return stream(self.seed, "busy building", self.world.fingerprint, purpose)

    @cached_property
    def _busy(self) -> NDArray[np.float64]:
        return on_shortest_ways(self.world, self._stream("ways"))

    @cached_property
    def _zones(self) -> "_Zones":
        rng = self._stream("zones")
        kind = np.repeat(["floor", "rush", "drift"], (N_FLOOR, N_RUSH, N_DRIFT))
        middles = rng.choice(self.world.n_states, size=len(kind), replace=False, p=self._busy)
        radius = round(ZONE_M / self.world.frame.cell)
        cells = np.array([around(self.world, int(middle), radius) for middle in middles], float)
        size = np.log(rng.uniform(*FACTORS, len(kind)))
        return _Zones(kind, cells, size, rng.uniform(7, 17, (2, len(kind))))

    @cached_property
    def _passages(self) -> tuple[NDArray[np.bool_], list[NDArray[np.float64]]]:
        """Cells of each passage, doors last, (n, n_states); the times at which each is blocked, opened, …"""
        rng = self._stream("passages")
        radius = max(round(PLACE_M / self.world.frame.cell), 1)
        cells = blocked_passages(self.world, rng, self._busy, N_BLOCKED + N_DOORS, radius)
        spans = rng.exponential((OPEN_DAYS, BLOCKED_DAYS), (len(cells), 500, 2)).reshape(len(cells), -1)
        return cells, list(MONDAY + DAY * np.cumsum(spans, axis=1))
