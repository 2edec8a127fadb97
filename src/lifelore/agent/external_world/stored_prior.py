"""Reads the prior of a life in a user's world out of a memory, and gives its contexts to other learners."""

import hashlib
from collections.abc import Callable, Hashable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import KIND, VERSION, ActionPrior
from lifelore.agent.external_world import context_labels
from lifelore.agent.external_world.context_code import MOST_ACTIONS, ContextCodes
from lifelore.agent.external_world.context_labels import ContextLabels
from lifelore.core.errors import InputError, NotFoundError
from lifelore.memory import Memory, open_memory


def prior_scope(key: str | None, n_actions: int) -> str:
    """The key under which memory stores the prior of these contexts and this number of actions."""
    # The text "foreign" is part of the key of stored priors.
    return hashlib.sha256(repr(("foreign", key, n_actions)).encode()).hexdigest()[:32]


def recalled_prior(memory: Memory | None, key: str | None, n_actions: int, alpha0: float) -> ActionPrior:
    """The prior in memory for these contexts and this number of actions; an empty prior if there is none."""
    scope = prior_scope(key, n_actions)
    known = memory.recall(KIND, scope, VERSION) if memory else None
    if known is None:
        return ActionPrior(n_actions, alpha0, scope)
    return ActionPrior.from_record(known, n_actions, alpha0)


def prior_from_memory(
    location: str | Path, *, key: str | None = None, n_actions: int | None = None, alpha0: float = 0.1
) -> ActionPrior:
    """The action prior that lives of `live_in` left in a memory, for other learners such as ``PriorDQN``.

    Parameters
    ----------
    location : str or Path
        SQLite file or ``postgresql://`` URL, as `live_in` takes it.
    key : str, optional
        The key of the lives, see `live_in`; not needed if the memory has a single prior of such lives.
    n_actions : int, optional
        Needed only if lives with several numbers of actions share the key.
    alpha0 : float
        Pseudo-count α⁰ of every action.

    Returns
    -------
    ActionPrior
        Its ``labels`` are the features of the contexts, so that ``to_frame()`` and `plot_prior` show these.
        Memories of older lives hold none; tables then show the codes.

    Raises
    ------
    NotFoundError
        The memory does not exist, or has no such prior; the message names the keys it has.
    InputError
        Several priors fit; the message names them.

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
        stored = _stored(memory)
        fits = [
            (meaning, n)
            for meaning, n in stored
            if (key is None or meaning == key) and (n_actions is None or n == n_actions)
        ]
        if not fits:
            raise NotFoundError(f"no prior of {_asked(key, n_actions)} in {location}; it has {_listed(stored)}")
        if len(fits) > 1:
            raise InputError(f"key and n_actions must select one prior in {location}; it has {_listed(fits)}")
        meaning, n = fits[0]
        prior = recalled_prior(memory, meaning, n, alpha0)
        labels = memory.recall(context_labels.KIND, prior.key, context_labels.VERSION)
        if labels is not None:
            prior.labels = ContextLabels(labels)
        return prior


def _stored(memory: Memory) -> list[tuple[str, int]]:
    """Key and number of actions of each prior that `live_in` stored."""
    stored = []
    for scope, version, about in memory.keys(KIND):
        if version == VERSION and about.get("prior") == "foreign":
            # A record has no number of actions; the hash of the right number is the record's key.
            meaning = about.get("means")
            n_actions = next((n for n in range(1, MOST_ACTIONS + 1) if prior_scope(meaning, n) == scope), None)
            if n_actions is not None:
                stored.append((meaning, n_actions))
    return stored


def _asked(key: str | None, n_actions: int | None) -> str:
    actions = "" if n_actions is None else f" for {n_actions} actions"
    return f"a life of live_in{actions}" if key is None else f"key '{key}'{actions}"


def _listed(stored: list[tuple[str, int]]) -> str:
    return ", ".join(f"'{key}' for {n} actions" for key, n in stored) or "none"


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
