"""Batches of observations of other libraries, and the check that a prior fits their actions."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError

Contexts = Callable[[Any], NDArray[np.int64]]
"""Maps a batch of observations, an array (n, …) or a dict of arrays, to the (n,) context codes of a prior."""


def as_batch(observation: Any) -> Any:
    """One observation as a batch of one."""
    if isinstance(observation, dict):
        return {key: np.asarray(value)[None] for key, value in observation.items()}
    return np.asarray(observation)[None]


def batch_size(observations: Any) -> int:
    """Number of observations in a batch."""
    return len(next(iter(observations.values())) if isinstance(observations, dict) else observations)


def check_actions(prior: ActionPrior, space: Any) -> None:
    """Raise InputError unless the prior has the actions of a space."""
    if getattr(space, "n", None) != prior.n_actions:
        raise InputError(f"prior must be for the environment's actions {space}, got one for {prior.n_actions}")
    if getattr(space, "start", 0) != 0:
        raise InputError(f"actions must be numbered from 0, got {space}; wrap the environment so that they are")
