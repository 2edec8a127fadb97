"""Log likelihoods of single moves by type, from counts of moves in training. Thesis: §4.8.4.1, §4.8.5.1."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.law import FixedLaw, Numbers
from lifelore.interaction.outcomes.outcome_rows import check_known

Array = NDArray[np.float64]

PRIOR_MOVES = 2.0
"""Moves added to each context, shared out evenly over its outcomes; more trust the counts of training less."""


class MoveSignal:
    """Signals that are numbers of moves: a context, and what became of the action in it.

    Parameters
    ----------
    log_table : (n_policies, n_signals, n_types) float
        Log likelihood of each move under each action set; minus infinity where a type cannot make it.

    Raises
    ------
    InputError
        The table has other axes, or holds NaN or infinity.

    Examples
    --------
    >>> signal = MoveSignal(np.log([[[0.9, 0.5], [0.1, 0.5]]]))
    >>> signal.log_likelihood(0, 1).round(3).tolist()
    [-2.303, -0.693]
    """

    def __init__(self, log_table: ArrayLike) -> None:
        self.log_table: Array = np.asarray(log_table, np.float64)
        if self.log_table.ndim != 3 or not self.log_table.size or not (self.log_table < np.inf).all():
            raise InputError(
                "log_table must be (n_policies, n_signals, n_types), below infinity and no NaN, got "
                f"{self.log_table.shape}"
            )
        self.n_policies, self.n_signals, self.n_types = self.log_table.shape

    @classmethod
    def from_counts(cls, counts: ArrayLike, n_outcomes: int) -> "MoveSignal":
        """The model from counts of moves; the likelihoods of a context's outcomes sum to 1.

        Parameters
        ----------
        counts : (n_policies, n_contexts · n_outcomes, n_types) float
            At least 0; the outcomes of a context are neighbours.

        Examples
        --------
        >>> signal = MoveSignal.from_counts([[[3.0], [1.0], [0.0], [0.0]]], n_outcomes=2)
        >>> np.exp(signal.log_table).ravel().round(3).tolist()
        [0.667, 0.333, 0.5, 0.5]
        """
        counts = np.asarray(counts, np.float64)
        n_policies, _, n_types = counts.shape
        moves = counts.reshape(n_policies, -1, n_outcomes, n_types) + PRIOR_MOVES / n_outcomes
        return cls(np.log(moves / moves.sum(axis=2, keepdims=True)).reshape(counts.shape))

    def log_likelihood(self, policy: int, signal: int) -> Array:
        """Log likelihood of a move per type, (n_types,).

        Raises
        ------
        InputError
            There is no such move.
        NotFoundError
            There is no such policy.
        """
        check_known("policy", policy, self.n_policies)
        return self.log_table[policy, self._checked(signal)]

    def law(self, models: Any = "uncertain", **_: Any) -> FixedLaw:
        """The law of many moves at once; what a user shows does not change it."""
        return FixedLaw(self, self.n_types, self._log_likelihoods, self._checked)

    def _log_likelihoods(self, policies: Numbers, signals: Any) -> Array:
        return self.log_table[policies, signals]

    def _checked(self, signals: Any) -> NDArray[np.int64]:
        moves = np.asarray(signals)
        if moves.dtype.kind not in "iu" or not ((moves >= 0) & (moves < self.n_signals)).all():
            raise InputError(f"a move must be a whole number from 0 to {self.n_signals - 1}, got {signals!r:.80}")
        return moves
