"""Runs as moves of a building, and the records by which memory learns them."""

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.action.demonstrations.demonstrations import Demonstration, count_demonstrations
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.learn_from.run_log import FIRST_CLOCK, Run
from lifelore.agent.learn_from.tried_moves import TriedMoves
from lifelore.agent.live import transitions
from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.lore import ABOUT_PRIOR, PERCEPT_KEY
from lifelore.agent.travel import Travel
from lifelore.core.learning.known_world import UNKNOWN, unknown_world
from lifelore.core.protocols import Record
from lifelore.domains.grids.grid_world import MOVE_NAMES

DRIVER = "robot"
"""Name of the agent of all demonstrations; the robot has another one in memory."""


@dataclass(frozen=True)
class LearntRun:
    """A run as moves in the building; the goal is the state in which it ended, None if that is no goal."""

    run: Run
    tried: TriedMoves
    goal: int | None

    @property
    def process(self) -> str:
        """The name under which memory knows the run."""
        return f"run {self.run.digest}"

    def demonstration(self, with_bumps: bool) -> Demonstration:
        """The moves as a demonstration of the way to the goal."""
        shown = self.tried.made | with_bumps
        return Demonstration(str(self.goal), DRIVER, self.tried.states[shown], self.tried.actions[shown])

    def records(self, place: Place, alpha0: float, weight: float) -> list[Record]:
        """The records by which memory learns the run.

        They hold the moves and walls that the map has too, times and bumps. A run that reached its goal also
        counts in the action prior, each move with this `weight`.
        """
        world, tried = place.world, self.tried
        old, seen = ~tried.new_obstacles, np.concatenate([tried.states, tried.targets])
        model = unknown_world(world.n_states, len(MOVE_NAMES))
        model.target[tried.states[old], tried.actions[old]] = tried.targets[old]
        model.percept[seen] = world.percepts[seen]
        # The whole run, also what memory knows already: the run may be the one that stays.
        known = transitions.to_record(world, transitions.model_table(world, model), UNKNOWN, place.grid)
        records = [known, *_travel(place, tried).news()]
        if self.goal is not None:
            news, shown = ActionPrior(len(MOVE_NAMES), alpha0, PERCEPT_KEY), self.demonstration(with_bumps=False)
            count_demonstrations(news, [shown], lambda each: world.percepts[each.states], {DRIVER: weight})
            records.append(news.to_record(ABOUT_PRIOR))
        return [record for record in records if len(record.slots)]


def _travel(place: Place, tried: TriedMoves) -> Travel:
    """The times of moves and the bumps, as observed."""
    travel, clock, timed = Travel(place.world, place.grid), _clock(tried.time), tried.seconds > 0
    travel.observe(tried.states[timed], tried.actions[timed], clock[timed], tried.seconds[timed])
    bumps = np.flatnonzero(tried.new_obstacles)
    for move in set(zip(tried.states[bumps].tolist(), tried.actions[bumps].tolist(), strict=True)):
        times = clock[bumps[(tried.states[bumps] == move[0]) & (tried.actions[bumps] == move[1])]]
        minutes = _refusals(times)
        states, actions = np.tile(move, (len(minutes), 1)).T
        travel.observe(states, actions, minutes, np.full(len(minutes), np.nan))
    return travel


def has_clock(seconds: NDArray[np.float64]) -> bool:
    """Whether times (n,) count from 1970."""
    return len(seconds) == 0 or bool(seconds[-1] >= FIRST_CLOCK)


def _refusals(times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Ascending times of bumps, each moved back to a minute of its own: refusals of one minute count once."""
    found: list[float] = []
    for latest in times[::-1].tolist():
        found.append(min(latest, found[-1] - 60.0) if found else latest)
    return np.maximum(found[::-1], 0.0)


def _clock(seconds: NDArray[np.float64]) -> NDArray[np.float64]:
    """Seconds since 1970; a run without a clock ends now."""
    return seconds if has_clock(seconds) else time.time() + seconds - seconds[-1]
