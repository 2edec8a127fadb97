"""What a learner leaves behind, episode by episode; filled in place by the kernels."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

EPISODE, STEP, TOTAL = 0, 1, 4
"""Places in the cursors of `Learner` and `Explorer`: episode and step under way, steps in all."""
GOALS, NEWS = 5, 6
"""Places in the cursor of `Explorer` alone: places known as goals, moves learnt since the last look."""


class Curve(NamedTuple):
    """Per episode, all (n_episodes,): discounted return, summed reward, steps, collisions, goal reached."""

    returns: NDArray[np.float64]
    rewards: NDArray[np.float64]
    steps: NDArray[np.int64]
    collisions: NDArray[np.int64]
    reached: NDArray[np.bool_]


def first_episodes(curve: Curve, n_episodes: int) -> Curve:
    """A copy of the first `n_episodes` of a curve."""
    return Curve(
        curve.returns[:n_episodes].copy(),
        curve.rewards[:n_episodes].copy(),
        curve.steps[:n_episodes].copy(),
        curve.collisions[:n_episodes].copy(),
        curve.reached[:n_episodes].copy(),
    )


def new_curve(shape: int | tuple[int, int]) -> Curve:
    """An empty learning curve of so many episodes, or a stack of them, (n_learners, n_episodes)."""
    return Curve(
        np.zeros(shape),
        np.zeros(shape),
        np.zeros(shape, np.int64),
        np.zeros(shape, np.int64),
        np.zeros(shape, np.bool_),
    )
