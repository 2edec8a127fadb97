"""Counted outcomes of one task (histogram, categories), with probabilities known from a finite number of runs.

What rules read is an outcome model of the same kind, with the probabilities that are expected given what the task
has shown. Thesis: §4.3.4; models as in §4.4.1.
"""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_bins import joined_ends_of, joined_to
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.dirichlet import DirichletRow, first_log_probability
from lifelore.interaction.outcomes.outcome_model import is_outcome, over_pairs, refuse_outcome
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.outcomes.task_outcomes import TaskOutcomes, normal_excess

if TYPE_CHECKING:
    from lifelore.interaction.outcomes.counted_outcomes import CountedOutcomes

Array = NDArray[np.float64]


class TaskCounts(TaskOutcomes):
    """P(U | type, policy) in one task, given the outcomes it has shown.

    Parameters
    ----------
    outcomes : CountedOutcomes
        The library's; read once and not changed.
    spread : Spread
    """

    def __init__(self, outcomes: "CountedOutcomes", spread: Spread) -> None:
        super().__init__(spread)
        self.outcomes, self._expected = outcomes, outcomes.take()
        # Copies: what the library learns later, the task does not see.
        self._counts, self._totals = outcomes.counts.copy(), outcomes.totals.copy()
        self._rows: dict[int, DirichletRow] = {}
        self._values = outcomes.cell_means
        within = np.maximum(outcomes.deviation**2, 0.0)
        totals = outcomes.totals.T
        self._by_spread = within / (1 / (1 / totals + spread.values[:, None, None]) + 1)
        self._tried_variance: dict[int, Array] = {}
        # Policies whose expected outcomes, and whose variance of the mean, are older than what the task has shown.
        self._stale: set[int] = set()
        self._stale_variance: set[int] = set()

    # ---- what the task has shown ---------------------------------------------------------------------------

    def predicted(self, policy: int, value: float) -> Array:
        """The log density of `value` given what the task has shown, (n_spreads, n_types)."""
        return self._log_density(policy, value, self._rows.get(policy))

    def predicted_anew(self, policy: int, value: float) -> Array:
        """`predicted` of a task that has shown nothing."""
        return self._log_density(policy, value, None)

    def learn(self, policy: int, value: float, log_weights: Array | None = None) -> None:
        """Take in an outcome of this task, and the spreads' log probabilities after it."""
        if log_weights is not None:
            self.log_weights = log_weights
        cell = self._cell(policy, value)
        if cell is not None:
            self._rows.setdefault(policy, self._law(policy)).shown[cell] += 1
        self._outdate()

    @property
    def tried(self) -> list[int]:
        """The policies that have shown an outcome, in the order of their first."""
        return list(self._rows)

    @property
    def shown(self) -> dict[int, Array]:
        """Counts of the cells (n_cells,) of each policy that was tried."""
        return {policy: row.shown.copy() for policy, row in self._rows.items()}

    def fade(self, keep: float) -> None:
        """Let everything that the task has shown count `keep` of what it did; the type may have changed."""
        self.fade_weights(keep)
        for row in self._rows.values():
            row.shown *= keep
        self._outdate()

    def state(self) -> dict[str, NDArray[Any]]:
        """What the task has shown: ``policies`` (m,), ``shown`` (m, n_cells): counts; ``log_weights``."""
        shown = np.array([row.shown for row in self._rows.values()]).reshape(-1, self.outcomes.n_cells)
        return {
            "policies": np.array(list(self._rows), np.int64),
            "shown": shown,
            "log_weights": self.log_weights.copy(),
        }

    def restore(self, state: dict[str, NDArray[Any]]) -> None:
        """Take over a `state`; the model then has the same bits."""
        policies, shown = np.asarray(state["policies"], np.int64), np.array(state["shown"], np.float64)
        if shown.shape != (len(policies), self.outcomes.n_cells) or not (np.isfinite(shown) & (shown >= 0)).all():
            raise InputError(f"a task's state must have {self.outcomes.n_cells} counts of each policy")
        if policies.size and not 0 <= policies.min() <= policies.max() < self.n_policies:
            raise InputError(f"a task's state must be of policies 0 to {self.n_policies - 1}")
        self.restore_weights(state["log_weights"])
        for policy, counts in zip(policies.tolist(), shown, strict=True):
            self._rows.setdefault(policy, self._law(policy)).shown = counts.copy()
        self._outdate()

    # ---- the model as rules use it -------------------------------------------------------------------------

    @property
    def expected(self) -> "CountedOutcomes":
        """The outcomes as expected in this task."""
        if self._stale:
            self._renew(sorted(self._stale))
            self._stale.clear()
        return self._expected

    @property
    def mean(self) -> Array:  # type: ignore[override]
        """Expected mean outcome, (n_types, n_policies)."""
        return self.expected.mean

    @property
    def deviation(self) -> Array:
        """Standard deviation of the next outcome, (n_types, n_policies)."""
        return self.expected.deviation

    @property
    def mean_variance(self) -> Array:
        """Variance of each pair's mean outcome, (n_types, n_policies)."""
        found = np.tensordot(np.exp(self.log_weights), self._by_spread, axes=1)
        weights = np.exp(self.log_weights)
        for policy in self._stale_variance:
            mean, variance = self._rows[policy].mean_and_variance(self._values)
            self._tried_variance[policy] = weights @ variance + weights @ (mean - weights @ mean) ** 2
        self._stale_variance.clear()
        for policy, column in self._tried_variance.items():
            found[:, policy] = column
        return found

    def expected_mean_excess(self, threshold: ArrayLike) -> Array:
        """E[max(m − threshold, 0)] of each pair's mean outcome m, taken as normal, (..., n_types, n_policies)."""
        return normal_excess(self.mean - over_pairs(threshold), self.mean_variance)

    def density(self, value: ArrayLike) -> Array:
        """Density (probability, where outcomes are discrete) of `value` for every pair, (..., T, P)."""
        return self.expected.density(value)

    def exceedance(self, threshold: ArrayLike) -> Array:
        """P(U > threshold) for every pair, (..., n_types, n_policies)."""
        return self.expected.exceedance(threshold)

    def expected_excess(self, threshold: ArrayLike) -> Array:
        """E[max(U − threshold, 0)] for every pair, (..., n_types, n_policies)."""
        return self.expected.expected_excess(threshold)

    def cumulative(self, policy: int, values: Array, types: Any = slice(None)) -> Array:
        """P(U ≤ value | type, policy) of `values` (n,), for all or some types, (n_types, n)."""
        return self.expected.cumulative(policy, values, types)

    def bounds(self) -> tuple[float, float]:
        """(U^min, U^max): the support."""
        return self.expected.bounds()

    def sample(self, generator: np.random.Generator, type_: int, policy: int, size: Any = None) -> Any:
        """Random next outcomes of a pair: a number, or an array of shape `size`."""
        return self.expected.sample(generator, type_, policy, size)

    def table(self, n_bins: int = 8) -> SignalTable:
        """The cells as signals; above `n_bins` cells, neighbours are joined so that they tell the types apart."""
        return self.expected.table(n_bins)

    def cuts(self, n_bins: int) -> list[NDArray[np.int64]]:
        """The cells that are joined into each of at most `n_bins` bins, as their ends, for each policy."""
        return [joined_ends_of(self._probs(policy), n_bins) for policy in range(self.n_policies)]

    def table_rows(self, policy: int, cuts: NDArray[np.int64], n_bins: int) -> Array:
        """P(bin | type) of the next outcome of a policy, (n_types, n_bins)."""
        rows = joined_to(self._probs(policy), np.asarray(cuts, np.int64))
        return np.pad(rows, ((0, 0), (0, max(0, n_bins - rows.shape[1]))))

    def _probs(self, policy: int) -> Array:
        return self.expected.counts[policy] / self.expected.totals[policy][:, None]

    def _cell(self, policy: int, value: float) -> int | None:
        if not is_outcome(policy, value, self.n_policies):
            refuse_outcome(policy, value, self.n_policies)
        return self.outcomes.cell_of(value)

    def _log_density(self, policy: int, value: float, row: DirichletRow | None) -> Array:
        """The log density of `value`, (n_spreads, n_types), by a row; None where nothing was shown."""
        cell = self._cell(policy, value)
        if cell is None:
            return np.full((len(self.log_weights), self.n_types), -np.inf)
        if row is None:
            found = first_log_probability(self._counts[policy], self.spread, cell)
        else:
            found = row.log_probability(cell)
        return found - np.log(self.outcomes.cell_sizes[cell])

    def _law(self, policy: int) -> DirichletRow:
        found = self._rows.get(policy)
        return DirichletRow(self._counts[policy], self.spread) if found is None else found

    def _outdate(self) -> None:
        """Have every policy that was tried computed again when read: all depend on the spreads' probabilities."""
        self._stale.update(self._rows)
        self._stale_variance.update(self._rows)

    def _renew(self, policies: list[int]) -> None:
        """Compute the expected outcomes of some policies again; no policy's bits depend on the others."""
        rows, weights = [self._rows[policy] for policy in policies], np.exp(self.log_weights)
        shown = np.array([row.shown for row in rows])
        total = shown.sum(axis=1)
        by_spread = np.array([row.prior for row in rows]) + shown[:, None, None]
        by_spread /= (np.array([row.weight for row in rows]) + total[:, None, None])[..., None]
        # One product a policy: BLAS may round the columns of a larger product differently.
        flat = by_spread.reshape(len(rows), len(weights), -1)
        probs = np.array([np.dot(weights[None], own) for own in flat]).reshape(len(rows), *by_spread.shape[2:])
        self._expected.replace(policies, probs * (self._totals[policies] + total[:, None])[..., None])
