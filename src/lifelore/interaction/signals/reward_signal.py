"""Reward signal: the instantaneous rewards of an episode, independent of one another.

Thesis: §4.4.2.2. `StepRewardSignal` conditions each reward on its state and action.
"""

from collections.abc import Iterable, Sequence
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.outcome_kinds import outcome_kind
from lifelore.interaction.outcomes.outcome_model import OutcomeModel
from lifelore.interaction.outcomes.outcome_rows import LARGEST, OutcomeRows, check_known, checked_rows, numbers

Array = NDArray[np.float64]


class RewardSignal:
    """Signals that are sequences of rewards: F(r_1 … r_n) = Π P(r_i | type, policy).

    Parameters
    ----------
    rewards : OutcomeModel
        P(r | type, policy) of a single reward: `CategoricalOutcomes` where rewards are few, or Gaussian.

    Examples
    --------
    >>> from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
    >>> signal = RewardSignal(CategoricalOutcomes([0, 1], [[[0.5, 0.5]], [[0.9, 0.1]]]))
    >>> signal.log_likelihood(0, [0, 0, 1]).round(3).tolist()
    [-2.079, -2.513]
    """

    kind: ClassVar[str] = "reward"
    inner: ClassVar[str] = "rewards"
    """Name of the model or models within it."""

    def __init__(self, rewards: OutcomeModel) -> None:
        self.rewards, self.n_types, self.n_policies = rewards, rewards.n_types, rewards.n_policies

    @classmethod
    def from_sequences(
        cls,
        sequences: Iterable[tuple[int, int, ArrayLike]],
        n_types: int,
        n_policies: int,
        model: str = "categorical",
        **options: Any,
    ) -> Self:
        """The model fitted to rewards of episodes.

        Parameters
        ----------
        sequences : iterable of (type, policy, rewards (n,))
        model, **options
            The outcome model and the options of its ``from_samples``.

        Raises
        ------
        InputError
            A pair has no reward, or a reward is not finite.
        """
        episodes = [(type_, policy, _numbers(rewards)) for type_, policy, rewards in sequences]
        if not episodes:
            raise InputError("sequences must hold at least one episode")
        lengths = [len(rewards) for _, _, rewards in episodes]
        types = np.repeat([type_ for type_, _, _ in episodes], lengths)
        policies = np.repeat([policy for _, policy, _ in episodes], lengths)
        if not ((types >= 0) & (types < n_types) & (policies >= 0) & (policies < n_policies)).all():
            raise InputError(f"sequences must name types 0 to {n_types - 1} and policies 0 to {n_policies - 1}")
        values = np.concatenate([rewards for _, _, rewards in episodes])
        rows = checked_rows(OutcomeRows(types, policies, values, (n_types, n_policies)))
        return cls(outcome_kind(model).from_rows(rows, **options))

    def log_likelihood(self, policy: int, signal: ArrayLike) -> Array:
        """Log likelihood of the rewards (n,) per type, (n_types,); 0 for no rewards.

        Raises
        ------
        InputError
            A reward is not finite.
        NotFoundError
            There is no such policy.
        """
        check_known("policy", policy, self.n_policies)
        rewards = _numbers(signal)
        return self.rewards.log_densities(np.full(len(rewards), policy), rewards).sum(axis=0)

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """The model of some types and policies."""
        return type(self)(self.rewards.take(types, policies))


def _numbers(rewards: ArrayLike) -> Array:
    rule = f"a signal of rewards must be finite numbers (n,) of at most {LARGEST:g}"
    found = numbers(rewards, rule)
    if found.ndim != 1 or not (np.abs(found) <= LARGEST).all():
        raise InputError(f"{rule}, got shape {found.shape}: {rewards!r:.80}")
    return found
