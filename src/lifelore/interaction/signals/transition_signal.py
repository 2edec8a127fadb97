"""Transition signal: the (s, a, s') tuples of an episode; the observation model is the type's transition function.

The signal with most information, and the most expensive to store. Thesis: §4.4.2.1.
"""

from collections.abc import Iterable, Sequence
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.signals.step_model import StepModel, step_counts, step_probs

Array = NDArray[np.float64]


class TransitionSignal(StepModel):
    """Signals that are sequences of (s, a, s'), or (s, s') where there is a single action; or one such step.

    Parameters
    ----------
    probs : (n_types, n_states, n_actions, n_states) or (n_types, n_policies, n_states, n_actions, n_states)
        T(s' | s, a; type), or also by policy.
    n_policies : int, optional
        Number of policies that share the table; any number where None.

    Examples
    --------
    >>> signal = TransitionSignal([[[[0.9, 0.1]], [[0.0, 1.0]]], [[[0.5, 0.5]], [[0.0, 1.0]]]])
    >>> signal.log_likelihood(0, [(0, 0), (0, 1)]).round(3).tolist()
    [-2.408, -1.386]
    """

    kind: ClassVar[str] = "transition"

    def __init__(self, probs: ArrayLike, n_policies: int | None = None, count: ArrayLike | None = None) -> None:
        super().__init__(probs, n_policies, count)
        if self.shape[0] != self.shape[2]:
            raise InputError(f"probs must lead from states to states, got {self.shape[0]} and {self.shape[2]}")

    @classmethod
    def from_counts(
        cls,
        counts: ArrayLike,
        pseudo_count: float = 0.5,
        possible: ArrayLike | None = None,
        n_policies: int | None = None,
    ) -> Self:
        """The model from counts of transitions, axes as ``probs``.

        Parameters
        ----------
        pseudo_count : float
            Added to each transition that is `possible`, ≥ 0.
        possible : bool, broadcastable to `counts`, optional
            Possible transitions; by default all.
        """
        probs, totals = step_probs(counts, pseudo_count, possible)
        return cls(probs, n_policies, totals)

    @classmethod
    def from_sequences(
        cls,
        sequences: Iterable[tuple[int, int, ArrayLike]],
        n_types: int,
        n_states: int,
        n_actions: int = 1,
        n_policies: int | None = None,
        pseudo_count: float = 0.5,
        possible: ArrayLike | None = None,
    ) -> Self:
        """The model from episodes (type, policy, steps); with `n_policies` each policy has its own table."""
        steps = ((type_, policy, _triples(rows)) for type_, policy, rows in sequences)
        counts = step_counts(steps, n_types, n_policies, (n_states, n_actions, n_states))
        return cls.from_counts(counts, pseudo_count, possible)

    def steps_of(self, signal: ArrayLike) -> NDArray[np.int64]:
        """A signal as steps (n, 3): state, action, next state."""
        return _triples(signal)

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """The model of some types and policies."""
        return type(self)(*self.taken(types, policies))


def _triples(signal: ArrayLike) -> NDArray[np.int64]:
    """Steps (n, 3): state, action, next state; InputError for anything else than rows of whole numbers."""
    try:
        found = np.asarray(signal)
    except ValueError:
        found = np.array(None)
    if not found.size:
        return np.empty((0, 3), np.int64)
    if found.ndim == 1:
        found = found[None]  # a single step
    if (
        found.dtype.kind in "iuf"
        and found.ndim == 2
        and found.shape[1] in (2, 3)
        and (np.abs(found) < 2**53).all()
    ):
        whole = found.astype(np.int64)
        if (whole == found).all():
            return whole if whole.shape[1] == 3 else np.insert(whole, 1, 0, axis=1)
    raise InputError(
        "a signal must be rows of (state, action, next state) or (state, next state), 2 or 3 columns of whole "
        f"numbers, got {signal!r:.80}"
    )
