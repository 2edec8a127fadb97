"""Protocols and records that rooms exchange: worlds, policies, signal models, records of memory."""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

Merge = Literal["add", "newest", "union"]
Progress = Callable[[int, int, str], None]
"""Progress reports of long work: ``progress(done, total, label)``, called from the caller's own thread."""


@runtime_checkable
class World(Protocol):
    """A world with discrete actions, in which an agent lives through one task after another.

    Attributes
    ----------
    n_actions : int
        Actions are the integers in [0, n_actions).

    States and contexts are finite numbers, text, tuples and the like, which have the same code in every process.

    Examples
    --------
    >>> from lifelore import GymnasiumWorld
    >>> import gymnasium as gym
    >>> isinstance(GymnasiumWorld(gym.make("CliffWalking-v1"), state=int, context=int), World)
    True
    """

    n_actions: int

    def reset(self, task: int, seed: int) -> Hashable:
        """Start an episode of task number `task`; the hashable state in which it starts."""
        ...

    def step(self, action: int) -> tuple[Hashable, float, bool, bool]:
        """Take an action: ``(state, reward, terminated, truncated)``."""
        ...

    def context(self, state: Hashable, last_reward: float) -> Hashable:
        """The hashable features of a state that an action prior is conditioned on."""
        ...


@runtime_checkable
class Policy(Protocol):
    """A policy: state in, action out. An array of actions indexed by state is a policy too.

    Examples
    --------
    >>> import numpy as np
    >>> from lifelore.core import greedy_policy
    >>> greedy_policy(np.array([[0.0, 2.0], [1.0, 0.0]])).tolist()
    [1, 0]
    """

    def __call__(self, state: Any) -> int: ...


@runtime_checkable
class SignalModel(Protocol):
    """Likelihood of an observed signal by type, under a policy (thesis §4.4).

    Examples
    --------
    >>> import numpy as np
    >>> class Presses:
    ...     rates = np.array([[0.2, 1.0], [2.0, 0.5]])  # of two types under two policies
    ...     def log_likelihood(self, policy, signal):
    ...         return signal * np.log(self.rates[:, policy]) - self.rates[:, policy]
    >>> Presses().log_likelihood(0, 3).round(1).tolist()
    [-5.0, 0.1]
    """

    def log_likelihood(self, policy: int, signal: Any) -> NDArray[np.float64]:
        """Log likelihood per type, shape ``(n_types,)``; minus infinity is allowed."""
        ...


@dataclass(frozen=True)
class Record:
    """Learned knowledge in the form that memory stores: integer slots with integer values, and their merge rule.

    Memory never interprets a record. Learners encode (context, action) pairs as `slots` and fixed-point
    weights or targets as `values`, and read records of an older `version` themselves.

    Parameters
    ----------
    kind : str
        Kind of knowledge, e.g. ``"action_prior"``.
    key : str
        Identity: a hash of all settings that two records must share to be merged.
    version : int
        Version of the encoding; different versions never merge.
    merge : {"add", "newest", "union"}
        ``add``: values of one slot sum (weights are fixed point, so any order and grouping gives the same
        bits). ``newest``: the value of the latest contribution wins. ``union``: a slot
        once present stays, with its largest value.
    slots, values : (n,) int64
        Slots are unique within a record.
    about : mapping of str to JSON values
        Description for people; merging ignores it.

    Examples
    --------
    >>> Record("goal_counts", "office", 1, "add", np.array([3, 7]), np.array([1, 2])).values.tolist()
    [1, 2]
    """

    kind: str
    key: str
    version: int
    merge: Merge
    slots: NDArray[np.int64]
    values: NDArray[np.int64]
    about: Mapping[str, Any] = field(default_factory=dict)
