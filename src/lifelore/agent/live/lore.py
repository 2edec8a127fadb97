"""What one agent has learnt so far in its life: action priors that travel, transitions that belong to a place."""

import hashlib
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import KIND as PRIOR_KIND
from lifelore.action.priors.action_prior import VERSION as PRIOR_VERSION
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.live import transitions
from lifelore.core.learning.known_world import WorldModel
from lifelore.core.protocols import Record
from lifelore.domains.grids.grid_world import MOVE_BITS, MOVE_NAMES, PERCEPT, GridWorld
from lifelore.memory import Memory


@dataclass(frozen=True)
class PriorScope:
    """What an action prior is conditioned on, and under which key it is kept.

    contexts : (n_states,) int64 code of each state
    coarser : masks of simpler features that rare contexts back off to
    """

    kind: str
    key: str
    contexts: NDArray[np.int64]
    coarser: tuple[int, ...]


def prior_scope(world: GridWorld, prior: str) -> PriorScope:
    """Observation priors are keyed by the percept's definition and the actions, so they travel; state priors
    by the world's fingerprint, so another map never mixes in."""
    if prior == "state":
        return PriorScope("state", world.fingerprint, transitions.cells_of(world), ())
    definition = repr((PERCEPT, MOVE_NAMES)).encode()
    key = hashlib.sha256(definition).hexdigest()[:32]
    return PriorScope("observation", key, world.percepts, (MOVE_BITS,))


@dataclass
class Lore:
    """One agent's lore in one world. `learn_prior` and `model_news` give what the last task added, for memory."""

    world: GridWorld
    scope: PriorScope
    prior: ActionPrior
    model: WorldModel
    _stored: NDArray[np.int64] = field(repr=False)

    @classmethod
    def recalled(cls, world: GridWorld, scope: PriorScope, alpha0: float, memory: Memory) -> "Lore":
        """What memory holds that bears on this world."""
        n_actions = world.neighbour.shape[1]
        record = memory.recall(PRIOR_KIND, scope.key, PRIOR_VERSION)
        prior = (
            ActionPrior.from_record(record, n_actions, alpha0)
            if record
            else ActionPrior(n_actions, alpha0, scope.key)
        )
        own = memory.recall(transitions.KIND, world.fingerprint, transitions.VERSION)
        model = transitions.from_record(world, own)
        stored = transitions.model_table(world, model)
        if own is None:
            changed = same_place(world, memory)
            model = transitions.from_record(world, changed)
        return cls(world, scope, prior, model, stored)

    def copy(self) -> "Lore":
        """An independent copy: an agent that goes on from the same lore."""
        prior = ActionPrior.merged([self.prior])
        model = WorldModel(self.model.target.copy(), self.model.percept.copy())
        return Lore(self.world, self.scope, prior, model, self._stored.copy())

    def learn_prior(self, best: NDArray[np.bool_], goal: int, weight: float) -> Record:
        """Count a finished task's policy (Eq. 3.5, 3.7) and return the contribution; the goal row never counts."""
        best = best.copy()
        best[goal] = False
        news = ActionPrior(self.prior.n_actions, self.prior.alpha0, self.scope.key)
        news.update(self.scope.contexts, best, weight)
        self.prior.merge(news)
        return news.to_record({"prior": self.scope.kind, "actions": list(MOVE_NAMES)})

    def model_news(self) -> Record:
        """Transitions known otherwise than memory has them."""
        table = transitions.model_table(self.world, self.model)
        record = transitions.to_record(self.world, table, self._stored)
        self._stored = table
        return record


def same_place(world: GridWorld, memory: Memory) -> Record | None:
    """The remembered transitions of this place before it changed, if memory has them."""
    best, best_share = None, transitions.SAME_PLACE
    for key, version, about in memory.keys(transitions.KIND):
        if version != transitions.VERSION or about.get("frame") != transitions.frame_key(world):
            continue
        record = memory.recall(transitions.KIND, key, version)
        share = transitions.agreement(world, record) if record else 0.0
        if share >= best_share:
            best, best_share = record, share
    return best
