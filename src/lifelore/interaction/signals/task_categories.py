"""Category signals of one task, whose probabilities are known from a finite number of runs. Thesis: §4.4.1."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_bins import joined_ends_of, joined_to
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.batch_likelihood import BatchLikelihood, LoopedLikelihood
from lifelore.interaction.outcomes.dirichlet import DirichletRow, first_log_probability
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.outcomes.task_outcomes import SpreadWeights, mixed

if TYPE_CHECKING:
    from lifelore.interaction.signals.category_signal import CategorySignal

Array = NDArray[np.float64]


class TaskCategories(SpreadWeights):
    """P(category | type, policy) in one task, given the signals it has shown.

    Parameters
    ----------
    signal : CategorySignal
        The library's, from counted signals; not changed.
    spread : Spread
    """

    def __init__(self, signal: "CategorySignal", spread: Spread) -> None:
        assert signal.totals is not None
        super().__init__(spread)
        self.signal, self.n_types, self.n_policies = signal, signal.n_types, signal.n_policies
        self._counts = np.ascontiguousarray((signal.probs * signal.totals[:, :, None]).transpose(1, 0, 2))
        self._rows: dict[int, DirichletRow] = {}

    def predicted(self, policy: int, signal: Any) -> Array:
        """The log probability of a signal given what the task has shown, (n_spreads, n_types)."""
        row = self._rows.get(policy)
        if row is None:
            return self.predicted_anew(policy, signal)
        return row.log_probability(self.signal.place_of(policy, signal))

    def predicted_anew(self, policy: int, signal: Any) -> Array:
        """`predicted` of a task that has shown nothing."""
        place = self.signal.place_of(policy, signal)
        return first_log_probability(self._counts[policy], self.spread, place)

    def log_likelihood(self, policy: int, signal: Any) -> Array:
        """Log probability of the signal per type, given what the task has shown, (n_types,)."""
        return mixed(self.predicted(policy, signal), self.log_weights)

    def batch_likelihood(self) -> BatchLikelihood:
        """Log probabilities of possible next signals; none of them is taken in."""
        return LoopedLikelihood(self.log_likelihood)

    def learn(self, policy: int, signal: Any, log_weights: Array | None = None) -> None:
        """Take in a signal of this task, and the spreads' log probabilities after it."""
        if log_weights is not None:
            self.log_weights = log_weights
        row = self._rows.setdefault(policy, self._rows.get(policy) or self._fresh(policy))
        row.shown[self.signal.place_of(policy, signal)] += 1

    def fade(self, keep: float) -> None:
        """Let everything that the task has shown count `keep` of what it did."""
        self.fade_weights(keep)
        for row in self._rows.values():
            row.shown *= keep

    @property
    def tried(self) -> list[int]:
        """The policies that have shown a signal, in the order of their first."""
        return list(self._rows)

    def cuts(self, n_bins: int) -> list[NDArray[np.int64]]:
        """The categories that are joined into each of at most `n_bins` bins, as their ends, for each policy."""
        return [joined_ends_of(self._probs(policy), n_bins) for policy in range(self.n_policies)]

    def table_rows(self, policy: int, cuts: NDArray[np.int64], n_bins: int) -> Array:
        """P(bin | type) of the next signal of a policy, (n_types, n_bins)."""
        rows = joined_to(self._probs(policy), np.asarray(cuts, np.int64))
        return np.pad(rows, ((0, 0), (0, max(0, n_bins - rows.shape[1]))))

    def table(self, n_bins: int = 8) -> SignalTable:
        """All categories where they are at most `n_bins`; otherwise neighbours are joined."""
        cuts = self.cuts(n_bins)
        width = max(len(found) for found in cuts)
        rows = [self.table_rows(policy, found, width) for policy, found in enumerate(cuts)]
        return SignalTable(np.stack(rows))

    def state(self) -> dict[str, NDArray[Any]]:
        """What the task has shown: ``policies`` (m,), ``shown`` (m, n_categories): counts; ``log_weights``."""
        shown = np.array([row.shown for row in self._rows.values()]).reshape(-1, self.signal.n_categories)
        return {
            "policies": np.array(list(self._rows), np.int64),
            "shown": shown,
            "log_weights": self.log_weights.copy(),
        }

    def restore(self, state: dict[str, NDArray[Any]]) -> None:
        """Take over a `state`; the model then has the same bits."""
        policies, shown = np.asarray(state["policies"], np.int64), np.array(state["shown"], np.float64)
        if shown.shape != (len(policies), self.signal.n_categories):
            raise InputError(f"a task's state must have {self.signal.n_categories} counts of each policy")
        self.restore_weights(state["log_weights"])
        for policy, counts in zip(policies.tolist(), shown, strict=True):
            self._rows.setdefault(policy, self._fresh(policy)).shown = counts.copy()

    def _fresh(self, policy: int) -> DirichletRow:
        return DirichletRow(self._counts[policy], self.spread)

    def _probs(self, policy: int) -> Array:
        row = self._rows.get(policy) or self._fresh(policy)
        return np.tensordot(np.exp(self.log_weights), row.probs(), axes=1)
