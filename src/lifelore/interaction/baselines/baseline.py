"""Base class of all baselines: selection and update for a single task or many tasks, ties, checks of input.

A baseline sees only the payoff of the policy it played. `n_tasks` plays that many independent tasks at once:
policies and payoffs are then arrays, and the state is ``(n_tasks, n_policies)`` arrays. Without it the same code
plays a single task with plain numbers. `library_moments` is the knowledge that a baseline without types can take
from a library.
"""

from abc import ABC, abstractmethod
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.outcome_rows import LARGEST
from lifelore.interaction.selection.choice import choose

LEAST = 1e-9
"""Deviation in place of 0 where a library is certain."""


class Baseline(ABC):
    """A way to choose among policies by payoffs alone.

    Parameters
    ----------
    n_policies : int
        At least 1.
    n_tasks : int, optional
        Number of tasks played at once, all with the same settings; by default a single task with plain numbers.
    seed : int or numpy generator
        Serves ties and draws.

    Attributes
    ----------
    episode : int
        Number of updates so far.
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
        self._generator = stream(seed, "baseline", self.name)

    @classmethod
    def from_library(cls, library: PolicyLibrary, **settings: Any) -> Self:
        """A baseline over the policies of `library` with the knowledge that the method can use.

        `settings` are the constructor's and override the library.
        """
        return cls(library.n_policies, **(cls.settings_from(library) | settings))

    @classmethod
    def settings_from(cls, library: PolicyLibrary) -> dict[str, Any]:
        """The arguments of the constructor that follow from a library; none by default."""
        return {}

    @property
    def rows(self) -> int:
        """Number of tasks: 1 without `n_tasks`."""
        return self.n_tasks or 1

    def select(self) -> Any:
        """The policy to play next: an int, or (n_tasks,) int64."""
        chosen = self._choose()
        return int(chosen[0]) if self.n_tasks is None else chosen

    def update(self, policy: ArrayLike, reward: ArrayLike) -> None:
        """Learn the payoff of `policy`; payoffs may come late and in any order.

        Parameters
        ----------
        policy : int, or (n_tasks,) int
        reward : float, or (n_tasks,) float
            Finite, of at most 1e100; larger is better.

        Raises
        ------
        NotFoundError
            A policy is outside 0 … n_policies - 1.
        InputError
            A payoff is not finite, or there is not a payoff for each task; the state stays.
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
        """The score of each policy, (rows, n_policies); infinity is allowed, NaN is not."""

    @abstractmethod
    def _learn(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        """Learn a payoff for each row."""


def row_of(name: str, values: ArrayLike, n_policies: int, least: float = -np.inf) -> NDArray[np.float64]:
    """`values` as (n_policies,) finite floats above `least`; a single number is for all policies."""
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


class Moments(NamedTuple):
    """First two moments of each policy's payoff when the type is drawn from the library's prior.

    mean : (n_policies,) float
        E[U].
    spread : (n_policies,) float
        Deviation of the mean payoff from type to type.
    noise : (n_policies,) float
        Deviation of a payoff about its type's mean, root mean square over types.
    """

    mean: NDArray[np.float64]
    spread: NDArray[np.float64]
    noise: NDArray[np.float64]


def library_moments(library: PolicyLibrary) -> Moments:
    """Moments under the library's prior G₀ over types."""
    prior, means = np.asarray(library.prior), np.asarray(library.performance.mean)
    mean = prior @ means
    spread = np.sqrt(prior @ (means - mean) ** 2)
    noise = np.sqrt(prior @ np.asarray(library.performance.deviation) ** 2)
    return Moments(mean, spread, noise)
