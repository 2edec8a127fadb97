"""The shapes in which strangers meet: what joins two rooms passes these, and nothing else."""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

Merge = Literal["add", "newest", "union"]
Progress = Callable[[int, int, str], None]
"""How long work reports itself: ``progress(done, total, label)``, called from the caller's own thread."""


@runtime_checkable
class World(Protocol):
    """A world with discrete actions, in which an agent lives through one task after another.

    Attributes
    ----------
    n_actions : int
        Actions are the integers in [0, n_actions).
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
    """A behaviour: state in, action out. An array of actions indexed by state serves as well."""

    def __call__(self, state: Any) -> int: ...


@runtime_checkable
class SignalModel(Protocol):
    """How likely each type makes an observed signal under a policy (thesis §4.4)."""

    def log_likelihood(self, policy: int, signal: Any) -> NDArray[np.float64]:
        """Log likelihood per type, shape ``(n_types,)``; minus infinity is allowed."""
        ...


@dataclass(frozen=True)
class Record:
    """Something learnt, in the form memory keeps: integer slots with integer values, and how they merge.

    Memory never interprets a record. Learners encode (context, action) pairs as `slots` and fixed-point
    weights or targets as `values`, and read records of an older `version` themselves.

    Parameters
    ----------
    kind : str
        What sort of lore, e.g. ``"action_prior"``.
    key : str
        Which instance: a hash of everything that must agree for two records to be about the same thing.
    version : int
        Version of the encoding; different versions never merge.
    merge : {"add", "newest", "union"}
        ``add``: values of one slot sum (weights are fixed point, so any order and grouping gives the same
        bits). ``newest``: the value of the latest contribution wins. ``union``: a slot
        once present stays; the largest value is kept.
    slots, values : (n,) int64
        Slots are unique within a record.
    about : mapping of str to JSON values
        For people: what the numbers mean. Never merged on.
    """

    kind: str
    key: str
    version: int
    merge: Merge
    slots: NDArray[np.int64]
    values: NDArray[np.int64]
    about: Mapping[str, Any] = field(default_factory=dict)
