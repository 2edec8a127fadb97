"""Step reward signal: the (s, a, r) tuples of an episode; the observation model is the type's reward function.

Thesis: §4.4.2.2, §4.6.2.
"""

from collections.abc import Iterable, Sequence
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.signals.step_model import StepModel, step_counts, step_probs

Array = NDArray[np.float64]


class StepRewardSignal(StepModel):
    """Signals that are sequences of (s, a, r) with rewards from a list.

    Parameters
    ----------
    rewards : (n_rewards,) float
        Possible rewards of a step, distinct.
    probs : (n_types, n_states, n_actions, n_rewards) or (n_types, n_policies, n_states, n_actions, n_rewards)
        P(r | s, a; type), or also by policy.
    n_policies : int, optional
        Number of policies that share the table; any number where None.

    Examples
    --------
    >>> signal = StepRewardSignal([0.0, 5.0], [[[[0.9, 0.1]]], [[[0.5, 0.5]]]])
    >>> signal.log_likelihood(0, [(0, 0, 0.0), (0, 0, 5.0)]).round(3).tolist()
    [-2.408, -1.386]
    """

    kind: ClassVar[str] = "step-reward"

    def __init__(
        self, rewards: ArrayLike, probs: ArrayLike, n_policies: int | None = None, count: ArrayLike | None = None
    ) -> None:
        super().__init__(probs, n_policies, count)
        self.rewards: Array = np.array(rewards, np.float64)
        self._index = _index_of(self.rewards, self.shape[2])

    @classmethod
    def from_sequences(
        cls,
        sequences: Iterable[tuple[int, int, Sequence[tuple[int, int, float]]]],
        rewards: ArrayLike,
        n_types: int,
        n_states: int,
        n_actions: int = 1,
        n_policies: int | None = None,
        pseudo_count: float = 0.5,
        possible: ArrayLike | None = None,
    ) -> Self:
        """The model from episodes (type, policy, steps); with `n_policies` each policy has its own table."""
        listed = np.array(rewards, np.float64)
        index = _index_of(listed, listed.size)
        steps = ((type_, policy, _coded(rows, index)) for type_, policy, rows in sequences)
        counts = step_counts(steps, n_types, n_policies, (n_states, n_actions, listed.size))
        probs, totals = step_probs(counts, pseudo_count, possible)
        return cls(listed, probs, count=totals)

    def steps_of(self, signal: Sequence[tuple[int, int, float]]) -> NDArray[np.int64]:
        """A signal as steps (n, 3): state, action, place of the reward in the list."""
        return _coded(signal, self._index)

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """The model of some types and policies."""
        return type(self)(self.rewards, *self.taken(types, policies))

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """The table and the rewards."""
        return {**super().to_arrays(), "rewards": self.rewards}

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        """The model of `to_arrays`, bit for bit."""
        model = super().from_arrays(arrays)
        model.rewards = np.array(arrays["rewards"], np.float64)
        model._index = _index_of(model.rewards, model.shape[2])
        return model


def _index_of(rewards: Array, n: int) -> dict[float, int]:
    index = {float(reward): place for place, reward in enumerate(rewards.ravel())}
    if rewards.shape != (n,) or len(index) != n or not np.isfinite(rewards).all():
        raise InputError(f"rewards must be {n} distinct finite numbers, got {rewards!r:.80}")
    return index


def _coded(signal: Sequence[tuple[int, int, float]], index: dict[float, int]) -> NDArray[np.int64]:
    """Steps (n, 3) with each reward as its place in the list."""
    try:
        coded = [(int(state), int(action), index[float(reward)]) for state, action, reward in signal]
    except KeyError as error:
        raise InputError(f"reward {error} is not among {list(index)[:10]}; list all possible rewards") from None
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"a signal must be rows of (state, action, reward), got {signal!r:.80}") from None
    return np.array(coded, np.int64).reshape(-1, 3)
