"""What every baseline shares: the two verbs, one task or many side by side, ties among equals, bad input.

A baseline sees the payoff of the policy it played and nothing else. `n_tasks` plays that many independent tasks
at once, row by row, with one call for all: policies and payoffs are then arrays, and the work is done on
``(n_tasks, n_policies)`` arrays. Without it the same code plays one task with plain numbers.
"""

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.interaction.outcomes.outcome_model import LARGEST
from lifelore.interaction.selection.choice import choose

if TYPE_CHECKING:
    from lifelore.interaction.library.policy_library import PolicyLibrary


class Baseline(ABC):
    """A way to choose among policies by payoffs alone.

    Parameters
    ----------
    n_policies : int
        At least 1.
    n_tasks : int, optional
        Play so many tasks at once, all with the same settings; default one task, with plain numbers.
    seed : int or numpy generator
        For ties and draws.

    Attributes
    ----------
    episode : int
        Updates so far.
    """

    name: ClassVar[str]

    def __init__(
        self, n_policies: int, *, n_tasks: int | None = None, seed: int | np.random.Generator = 0
    ) -> None:
        if n_policies < 1:
            raise InputError(f"n_policies must be at least 1, got {n_policies}")
        if n_tasks is not None and n_tasks < 1:
            raise InputError(f"n_tasks must be at least 1, got {n_tasks}; leave it out for a single task")
        self.n_policies, self.n_tasks, self.episode = n_policies, n_tasks, 0
        self._generator = seed if isinstance(seed, np.random.Generator) else stream(seed, "baseline", self.name)

    @classmethod
    def from_library(cls, library: "PolicyLibrary", **settings: Any) -> Self:
        """A baseline over the policies of `library`, given what of it the method can use.

        `settings` are the constructor's and override what the library says.
        """
        return cls(library.n_policies, **settings)

    @property
    def rows(self) -> int:
        """Tasks played: 1 where `n_tasks` was left out."""
        return self.n_tasks or 1

    def select(self) -> Any:
        """The policy to play next: an int, or (n_tasks,) int64."""
        chosen = self._choose()
        return int(chosen[0]) if self.n_tasks is None else chosen

    def update(self, policy: ArrayLike, reward: ArrayLike) -> None:
        """Take in what `policy` paid; late and out-of-order payoffs are as good as fresh ones.

        Parameters
        ----------
        policy : int, or (n_tasks,) int
        reward : float, or (n_tasks,) float
            Finite, of at most 1e100; larger is better.

        Raises
        ------
        NotFoundError
            A policy that is not 0 … n_policies - 1.
        InputError
            A payoff that is not finite, or not one for each task; nothing is learnt from any then.
        """
        policies, rewards = self._checked_policies(policy), self._checked_rewards(reward)
        self._learn(policies, rewards)
        self.episode += 1

    def _checked_policies(self, policy: ArrayLike) -> NDArray[np.int64]:
        policies = np.atleast_1d(np.asarray(policy))
        self._check_shape("policy", policies)
        if policies.dtype.kind not in "iu":
            raise InputError(f"policy must be a whole number, got {policy!r}")
        if ((policies < 0) | (policies >= self.n_policies)).any():
            raise NotFoundError(f"unknown policy {policy!r}; policies are 0 to {self.n_policies - 1}")
        return policies.astype(np.int64)

    def _checked_rewards(self, reward: ArrayLike) -> NDArray[np.float64]:
        rewards = np.atleast_1d(np.asarray(reward, np.float64))
        self._check_shape("reward", rewards)
        if not (np.abs(rewards) <= LARGEST).all():
            raise InputError(f"reward must be finite and of at most {LARGEST:g}, got {reward!r:.80}")
        return rewards

    def _check_shape(self, what: str, values: NDArray) -> None:
        if values.shape != (self.rows,):
            raise InputError(f"{what} must be one for each of {self.rows} tasks, got shape {values.shape}")

    def _choose(self) -> NDArray[np.int64]:
        """The policy of each task, (rows,): of the largest score, equals at random."""
        return choose(self._scores(), self._generator)

    @abstractmethod
    def _scores(self) -> NDArray[np.float64]:
        """What each policy is worth playing, (rows, n_policies); infinity is allowed, NaN is not."""

    @abstractmethod
    def _learn(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        """Take in one payoff a row."""


def row_of(name: str, values: ArrayLike, n_policies: int, least: float = -np.inf) -> NDArray[np.float64]:
    """`values` as (n_policies,) finite floats above `least`; one number stands for all policies."""
    try:
        row = np.broadcast_to(np.asarray(values, np.float64), (n_policies,))
    except ValueError:
        raise InputError(
            f"{name} must be one number or {n_policies} of them, got shape {np.shape(values)}"
        ) from None
    if not np.isfinite(row).all() or not (row > least).all():
        above = "" if least == -np.inf else f" and above {least:g}"
        raise InputError(f"{name} must be finite{above}, got {values!r}")
    return row.copy()
