"""Runs as moves of a building, and the records by which memory learns them, each run once."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from lifelore.action.demonstrations.demonstrations import Demonstration, count_demonstrations
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.learn_from.run_log import Run
from lifelore.agent.learn_from.tried_moves import TriedMoves
from lifelore.agent.live import transitions
from lifelore.agent.live.buildings.recognition import Place
from lifelore.agent.live.life_settings import PriorSettings
from lifelore.agent.live.lore import Lore, prior_scope
from lifelore.agent.travel import Travel
from lifelore.core.learning.known_world import UNKNOWN, unknown_world
from lifelore.core.protocols import Progress, Record
from lifelore.domains.grids.grid_world import MOVE_NAMES
from lifelore.memory import Memory

FIRST_CLOCK = 1e9
"""Seconds since 1970: times from here on are of a clock, smaller ones count from the start of a robot."""


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

    def demonstration(self, robot: str, with_bumps: bool) -> Demonstration:
        """The moves as a demonstration of the way to the goal."""
        shown = self.tried.made | with_bumps
        return Demonstration(str(self.goal), robot, self.tried.states[shown], self.tried.actions[shown])


@dataclass(frozen=True)
class RunStore:
    """Where runs are stored: a place, and the robot and source to which its memory attributes them."""

    place: Place
    memory: Memory
    robot: str
    prior: PriorSettings
    source: str

    def count_new(self, learnt: Sequence[LearntRun]) -> int:
        """The number of runs that memory does not have."""
        return sum(not self.memory.is_known(self.robot, one.process, self._seq(one)) for one in learnt)

    def store(self, learnt: Sequence[LearntRun], weights: Mapping[str, float], progress: Progress | None) -> int:
        """Store each run in one transaction; the number of those that memory did not have.

        weights : competence of the robot, where a run reached its goal
        """
        self._store_building()
        new = 0
        for done, one in enumerate(learnt, start=1):
            records = [*self._moves(one.tried), *self._prior(one, weights)]
            goal = None if one.goal is None else self.place.world.cells[one.goal].tolist()
            task = {
                "run": one.run.name,
                "goal": goal,
                "world": self.place.world.fingerprint,
                "source": self.source,
            }
            new += self.memory.contribute(
                self.robot, _filled(records), process=one.process, seq=self._seq(one), task=task
            )
            if progress:
                progress(done, len(learnt), f"run {one.run.name}")
        return new

    def _seq(self, one: LearntRun) -> int:
        """A run that was forgotten has a tombstone, and comes again under the next number."""
        return self.memory.times_forgotten(self.robot, one.process)

    def _store_building(self) -> None:
        """Store the building and what carries over from its earlier map; both stay if the runs are forgotten."""
        world = self.place.world
        scope = prior_scope(world, "observation")
        lore = Lore.recalled(world, scope, self.prior.alpha0, self.memory, self.place.grid)
        if records := _filled([*self.place.news, lore.model_news()]):
            task = {"world": world.fingerprint}
            self.memory.contribute(self.robot, records, process=uuid4().hex, seq=0, task=task)

    def _moves(self, tried: TriedMoves) -> list[Record]:
        """Records of the moves and walls that the map has too, and of times and bumps."""
        world, old = self.place.world, ~tried.new_obstacles
        model = unknown_world(world.n_states, len(MOVE_NAMES))
        model.target[tried.states[old], tried.actions[old]] = tried.targets[old]
        seen = np.concatenate([tried.states, tried.targets])
        model.percept[seen] = world.percepts[seen]
        table = transitions.model_table(world, model)
        # The whole run, also what memory knows already: the run may be the one that stays.
        known = transitions.to_record(world, table, np.full_like(table, UNKNOWN), self.place.grid)
        return [known, *self._travel(tried).news()]

    def _travel(self, tried: TriedMoves) -> Travel:
        """The times of moves and the bumps, as observed."""
        travel, clock, timed = Travel(self.place.world, self.place.grid), _clock(tried.time), tried.seconds > 0
        travel.observe(tried.states[timed], tried.actions[timed], clock[timed], tried.seconds[timed])
        bumps = np.flatnonzero(tried.new_obstacles)
        for move in set(zip(tried.states[bumps].tolist(), tried.actions[bumps].tolist(), strict=True)):
            times = clock[bumps[(tried.states[bumps] == move[0]) & (tried.actions[bumps] == move[1])]]
            minutes = _refusals(times)
            states, actions = np.tile(move, (len(minutes), 1)).T
            travel.observe(states, actions, minutes, np.full(len(minutes), np.nan))
        return travel

    def _prior(self, one: LearntRun, weights: Mapping[str, float]) -> list[Record]:
        """The record of the action prior of a run that reached its goal."""
        if one.goal is None:
            return []
        scope = prior_scope(self.place.world, "observation")
        news = ActionPrior(len(MOVE_NAMES), self.prior.alpha0, scope.key)
        shown, weight = one.demonstration(self.robot, False), weights[self.robot] * self.prior.weight
        count_demonstrations(news, [shown], lambda each: scope.contexts[each.states], {self.robot: weight})
        return [news.to_record({"prior": scope.kind, "actions": list(MOVE_NAMES)})]


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


def _filled(records: Sequence[Record]) -> list[Record]:
    return [record for record in records if len(record.slots)]
