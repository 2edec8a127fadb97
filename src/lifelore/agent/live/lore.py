"""`Lore`: the knowledge of one agent, an action prior for many places and the transitions of one place."""

import hashlib
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import KIND as PRIOR_KIND
from lifelore.action.priors.action_prior import VERSION as PRIOR_VERSION
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.live import transitions
from lifelore.agent.live.goals.goal_counts import GoalCounts
from lifelore.agent.live.transitions import BuildingGrid
from lifelore.core.learning.known_world import UNKNOWN, WorldModel
from lifelore.core.learning.tour_search import KnownTour
from lifelore.core.protocols import Record
from lifelore.domains.grids.grid_world import MOVE_NAMES, PERCEPT, GridWorld
from lifelore.memory import Memory

PERCEPT_KEY = hashlib.sha256(repr((PERCEPT, MOVE_NAMES)).encode()).hexdigest()[:32]
"""Key of the action prior that all grid worlds share: the definition of the percept and the actions."""
ABOUT_PRIOR = {"prior": "observation", "actions": list(MOVE_NAMES)}
"""What memory says of this prior."""


@dataclass
class Lore:
    """Knowledge of one agent in one world. `learn_prior` and `model_news` return what the last task added."""

    world: GridWorld
    prior: ActionPrior
    model: WorldModel
    grid: BuildingGrid
    goals: GoalCounts
    _stored: NDArray[np.int64] = field(repr=False)
    _tour: KnownTour | None = field(default=None, repr=False)

    @classmethod
    def recalled(cls, world: GridWorld, alpha0: float, memory: Memory, grid: BuildingGrid | None = None) -> "Lore":
        """The knowledge in memory about this world; `grid` is that of its building, by default its own."""
        grid = grid or BuildingGrid(transitions.frame_key(world))
        n_actions = world.neighbour.shape[1]
        record = memory.recall(PRIOR_KIND, PERCEPT_KEY, PRIOR_VERSION)
        prior = (
            ActionPrior.from_record(record, n_actions, alpha0)
            if record
            else ActionPrior(n_actions, alpha0, PERCEPT_KEY)
        )
        own = memory.recall(transitions.KIND, world.fingerprint, transitions.VERSION)
        model = transitions.from_record(world, own, grid.corner)
        stored = transitions.model_table(world, model)
        if own is None:
            changed = same_place(world, memory, grid)
            model = transitions.from_record(world, changed.record if changed else None, grid.corner)
            if changed and changed.record.about["frame"] != grid.frame:
                transitions.forget_contradicted(world, model)
            elif changed and grid.building is not None and changed.record.about.get("building") == grid.building:
                transitions.forget_changed(world, model)
        return cls(world, prior, model, grid, GoalCounts.recalled(world, grid, memory), stored)

    def copy(self) -> "Lore":
        """An independent copy for another agent."""
        prior = ActionPrior.merged([self.prior])
        model = WorldModel(self.model.target.copy(), self.model.percept.copy())
        return Lore(self.world, prior, model, self.grid, self.goals.copy(), self._stored.copy())

    def learn_prior(self, best: NDArray[np.bool_], goal: int, weight: float) -> Record:
        """Count the policy of a finished task without its goal row (Eq. 3.5, 3.7); return the contribution."""
        best = best.copy()
        best[goal] = False
        news = ActionPrior(self.prior.n_actions, self.prior.alpha0, PERCEPT_KEY)
        news.update(self.world.percepts, best, weight)
        self.prior.merge(news)
        return news.to_record(ABOUT_PRIOR)

    @property
    def known_places(self) -> int:
        """Number of states that the agent knows."""
        return int((self.model.percept != UNKNOWN).sum())

    def known_tour(self) -> KnownTour:
        """A short closed tour of the known places, and the remembered destinations that are tried before it."""
        self._tour = KnownTour.of(self.model, self.world.cells, self._tour)
        return self._tour.with_destinations(self.goals.belief()[0], self.goals.order)

    def model_news(self) -> Record:
        """Transitions that differ from those in memory, as a record."""
        table = transitions.model_table(self.world, self.model)
        record = transitions.to_record(self.world, table, self._stored, self.grid)
        self._stored = table
        return record


class EarlierVersion(NamedTuple):
    """Stored transitions of an earlier version of a place, and the share of its cells that are unchanged."""

    record: Record
    agreement: float


def same_place(world: GridWorld, memory: Memory, grid: BuildingGrid) -> EarlierVersion | None:
    """The stored version of this place with the most unchanged cells; None if there is none.

    Versions that are not known to be of this building must agree in `SAME_PLACE` of their cells. A version of this
    building by a robot of another radius counts where there is none by a robot of this radius.
    """
    best, best_rank = None, (False, 0.0)
    for key, version, about in memory.keys(transitions.KIND):
        building, same_frame = about.get("building"), about.get("frame") == grid.frame
        known = grid.building is not None and building == grid.building
        other_radius = known and about.get("settings", {}).get("cell") == world.frame.cell
        foreign = not known and None not in (building, grid.building)
        if version != transitions.VERSION or foreign or not (same_frame or other_radius):
            continue
        record = memory.recall(transitions.KIND, key, version)
        share = transitions.agreement(world, record, grid.corner) if record else 0.0
        rank = same_frame, share
        if record and share >= (0.0 if known else transitions.SAME_PLACE) and rank >= best_rank:
            best, best_rank = EarlierVersion(record, share), rank
    return best
