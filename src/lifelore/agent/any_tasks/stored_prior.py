"""Reads the prior of a life in a user's world out of a memory, and gives its contexts to other learners."""

from collections.abc import Callable, Hashable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.any_tasks.experience import Experience
from lifelore.agent.external_world.context_code import ContextCodes
from lifelore.core.errors import InputError, NotFoundError
from lifelore.memory import open_memory


def prior_from_memory(location: str | Path, *, key: str | None = None, alpha0: float = 0.1) -> ActionPrior:
    """The action prior that lives left in a memory, for other learners such as ``PriorDQN``.

    Parameters
    ----------
    location : str or Path
        SQLite file or ``postgresql://`` URL, as `live_in` takes it.
    key : str, optional
        The key of the lives; not needed if the memory holds lives of a single key.
    alpha0 : float
        Pseudo-count α⁰ of every action.

    Returns
    -------
    ActionPrior
        Its ``labels`` are the features of the contexts, so that ``to_frame()`` and `plot_prior` show these.

    Raises
    ------
    NotFoundError
        The memory does not exist, or has no such prior; the message names the keys it has.
    InputError
        The memory holds lives of several keys and none is given; the message names them.

    Examples
    --------
    >>> import tempfile
    >>> import gymnasium as gym
    >>> from lifelore import GymnasiumWorld, live_in
    >>> make = lambda task: gym.make("CliffWalking-v1", is_slippery=task % 2 == 1)
    >>> world = GymnasiumWorld(make, state=int, context=lambda place: place // 12)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     report = live_in(world, tasks=2, episodes=30, max_steps=200, memory=f"{folder}/a.db", key="cliff")
    ...     prior_from_memory(f"{folder}/a.db", key="cliff").n_actions
    4
    """
    if "://" not in str(location) and not Path(location).exists():
        raise NotFoundError(f"no memory at {location}; give the memory= of your live_in")
    with open_memory(location) as memory:
        known = Experience.keys(memory)
        if key is None and len(known) > 1:
            raise InputError(f"key must select one prior in {location}; it has {', '.join(known)}")
        wanted = key if key is not None or not known else known[0]
        found = None if wanted is None else Experience.recalled(wanted, memory, alpha0, labels=location)
        if found is None:
            raise NotFoundError(f"no prior of key {wanted!r} in {location}; it has {', '.join(known) or 'none'}")
        len(found.prior.labels)  # Read now: the memory may be gone later.
        return found.prior


class BatchContexts:
    """Context codes of batches of observations, the same codes as in a life: ``contexts`` for ``PriorDQN``.

    Parameters
    ----------
    context : callable
        ``context(observation)`` to hashable features, the function that `GymnasiumWorld` had in the life.

    Examples
    --------
    >>> contexts = BatchContexts(lambda seen: int(seen[0] > 0))
    >>> codes = contexts(np.array([[0.5], [-1.0], [2.0]]))
    >>> bool(codes[0] == codes[2] != codes[1]), sorted(contexts.labels.values())
    (True, [0, 1])
    """

    def __init__(self, context: Callable[[Any], Hashable]) -> None:
        self.context = context
        self._codes = ContextCodes()

    @property
    def labels(self) -> dict[int, Hashable]:
        """Code to features of the contexts met so far, as `ActionPrior.to_frame` and `plot_prior` take it."""
        return self._codes.contexts

    def __call__(self, observations: Any) -> NDArray[np.int64]:
        """The (n,) codes of a batch: an array (n, …), a dict of such arrays, or a list of observations."""
        return np.array([self._codes[self.context(seen)] for seen in _single(observations)], np.int64)


def _single(observations: Any) -> list[Any]:
    if isinstance(observations, Mapping):
        n = len(next(iter(observations.values())))
        return [{name: values[place] for name, values in observations.items()} for place in range(n)]
    return list(observations)
