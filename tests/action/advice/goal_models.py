"""Goal models of known policies."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from lifelore.action import ActionPrior, GoalModel


def goal_model_of(
    best: ArrayLike, goals: Sequence[int] = (), steps: ArrayLike | None = None, alpha0: float = 0.1
) -> GoalModel:
    """Count a policy's best or tied-best actions, (n_states, n_actions) bool; rows of goals are all False.

    `steps` (n_states,) defaults to 0 in states with counts, which makes all goals equally far.
    """
    best = np.asarray(best)
    prior = ActionPrior(best.shape[-1], alpha0)
    prior.update(np.arange(len(best)), best)
    far = np.zeros(len(best)) if steps is None else np.asarray(steps, np.float64)
    return GoalModel(tuple(goals), prior, np.where(best.any(axis=1), far, np.inf))
