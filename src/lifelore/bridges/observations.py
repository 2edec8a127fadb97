"""Observations of other people's systems, alone and in batches, and what a prior must agree with."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError

Contexts = Callable[[Any], NDArray[np.int64]]
"""From a batch of observations, an array (n, …) or a dict of such, to the (n,) codes a prior counts under."""


def as_batch(observation: Any) -> Any:
    """One observation as a batch of one."""
    if isinstance(observation, dict):
        return {key: np.asarray(value)[None] for key, value in observation.items()}
    return np.asarray(observation)[None]


def batch_size(observations: Any) -> int:
    """How many observations a batch holds."""
    return len(next(iter(observations.values())) if isinstance(observations, dict) else observations)


def check_actions(prior: ActionPrior, space: Any) -> None:
    """InputError unless the prior is for a space's actions."""
    if getattr(space, "n", None) != prior.n_actions:
        raise InputError(f"prior must be for the environment's actions {space}, got one for {prior.n_actions}")
    if getattr(space, "start", 0) != 0:
        raise InputError(f"actions must be numbered from 0, got {space}; wrap the environment so that they are")
