"""Learning curves, which kernels fill in place, and the places in the cursor of a learner."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

EPISODE, STEP, STATE, TOTAL = 0, 1, 2, 4
"""Places in the cursors of `QLearner` and `ModelLearner`: current episode, step and state; steps in all."""
REWARD_CLASS = 3
"""Place in the cursor of `QLearner` alone: class of the last reward."""
PLAN_LENGTH, GOALS, NEWS = 3, 5, 6
"""Places in the cursor of `ModelLearner` alone: actions left in the plan, known goals, 1 where moves are new."""
RETURN, DISCOUNT = 0, 1
"""Places in `running` of both learners: return so far, and the discount it has reached."""


class Curve(NamedTuple):
    """Per episode, all (n_episodes,): discounted return, summed reward, steps, collisions, goal reached."""

    returns: NDArray[np.float64]
    rewards: NDArray[np.float64]
    steps: NDArray[np.int64]
    collisions: NDArray[np.int64]
    reached: NDArray[np.bool_]


def first_episodes(curve: Curve, n_episodes: int) -> Curve:
    """A copy of the first `n_episodes` of a curve."""
    return Curve._make(part[:n_episodes].copy() for part in curve)


def new_curve(episodes: int) -> Curve:
    """An empty learning curve."""
    return Curve._make(np.zeros(episodes, kind) for kind in ("f8", "f8", "i8", "i8", "?"))
