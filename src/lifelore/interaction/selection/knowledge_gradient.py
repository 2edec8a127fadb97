"""Knowledge gradient: expected utility now, plus the expected gain of the best choice after the signal.

    v(π) = Σ_σ max_q Σ_τ β(τ) F(σ | τ, π) E[U | τ, q] − max_q Ũ(q)

The posterior of each signal need not be normalised: its weight is the sum that it would be divided by. So v is a
matrix product and a maximum. The thesis (Eq. 4.6) averages over signals *before* it takes the maximum; then the
two terms are equal and v is 0 for every policy. `variant="thesis"` is as printed. Thesis: §4.5.2.3.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.belief import expected_utility
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection.exact_best import exact_best
from lifelore.interaction.selection.knowledge_bounds import exact_gain, joined_gain, rounded_gain
from lifelore.interaction.selection.rule import Array, Deterministic, Variant, check_variant, in_blocks
from lifelore.interaction.selection.signal_rows import MOST_NUMBERS, signal_rows
from lifelore.interaction.selection.support import MASS, check_mass, supported_types

Candidates = Literal["auto", "responses", "all"]

LARGEST_EXACT = 1 << 22
"""Number of products n_types n_policies² n_signals up to which "auto" considers all policies; more costs time: at
this number a decision takes 0.3 ms, beside 0.2 ms with the best responses alone."""

LEAST_EXACT = 32
"""Least number of policies whose gain is computed exactly in large tables; more costs time and misses less."""
EXACT_WORK = 1 << 29
"""Number of products that exact gains in large tables may take, where that allows more than `LEAST_EXACT`."""


@dataclass(frozen=True)
class KnowledgeGradient(Deterministic):
    """Ũ(π) + (K − t) v(π).

    Parameters
    ----------
    variant : {"standard", "thesis"}
    mass : float
        Share of the belief that is used, in (0, 1].
    n_bins : int
        Number of bins of real-valued signals.
    lookahead : float
        Value of K − t where the agent has no horizon; ≥ 0.
    candidates : {"auto", "responses", "all"}
        Policies considered as the next choice: the best responses to the types of the support and the policy that
        is best now, or all policies. Only "all" considers a policy that is best on no type but second best on
        many. "auto" considers all policies of a small library (see `LARGEST_EXACT`) and the best responses in a
        larger library.

    Raises
    ------
    InputError
        `mass` lies outside (0, 1], `lookahead` is negative, or there is no such variant.
    """

    variant: Variant = "standard"
    mass: float = MASS
    n_bins: int = 8
    lookahead: float = 50.0
    candidates: Candidates = "auto"
    name: ClassVar[str] = "knowledge-gradient"

    def __post_init__(self) -> None:
        check_variant(self.variant)
        check_mass(self.mass)
        if not (self.lookahead >= 0 and np.isfinite(self.lookahead)):
            raise InputError(f"lookahead must be at least 0, got {self.lookahead}")
        if self.candidates not in ("auto", "responses", "all"):
            raise InputError(f"candidates must be 'auto', 'responses' or 'all', got {self.candidates!r}")

    def scores(
        self, library: PolicyLibrary, belief: Array, *, episodes_left: float | None = None, **_: Any
    ) -> Array:
        """Expected utilities plus the weighted gain of learning, (..., n_policies); see `knowledge_scores`."""
        mean, table = library.performance.mean, library.table(self.n_bins)
        weight = self.lookahead if episodes_left is None else episodes_left
        if self.variant == "thesis":
            return expected_utility(belief, mean) + weight * printed_gain(belief, mean, table)
        return knowledge_scores(belief, mean, table, weight, self.mass, self.candidates)


def knowledge_gain(
    belief: Array, mean: Array, table: SignalTable, mass: float = 1.0, candidates: Candidates = "all"
) -> Array:
    """v(π) of every policy, (..., n_policies), at least 0 up to rounding.

    Parameters
    ----------
    belief : (..., n_types) float
    mean : (n_types, n_policies) float
    table : SignalTable
    mass : float
        Share of the belief that is used.
    candidates : {"auto", "responses", "all"}
        As for `KnowledgeGradient`.
    """
    every = _considers_all(candidates, table)

    def gain_of(belief: Array) -> Array:
        support, weighted_means = _weighted_means(belief, mean, mass, every)
        return exact_gain(np.arange(table.n_policies), support, weighted_means, table)

    rows = np.asarray(belief, np.float64)
    if rows.ndim == 1:
        return gain_of(rows)
    flat = np.array([gain_of(row) for row in rows.reshape(-1, rows.shape[-1])])
    return flat.reshape(*rows.shape[:-1], table.n_policies)


def knowledge_scores(
    belief: Array,
    mean: Array,
    table: SignalTable,
    weight: float,
    mass: float = 1.0,
    candidates: Candidates = "all",
) -> Array:
    """Ũ(π) + weight v(π) of every policy, (..., n_policies), quickly for a single belief.

    A score that may be the largest is exact. In tables of up to 16 million numbers, any other score differs from
    the exact score by no more than the rounding of float32.

    In larger tables the gains of joined signals select the policies that are computed exactly: at least
    `LEAST_EXACT`, and as many as take some 10 ms. The scores of the others are lower bounds, so the best policy
    may be missed. Many beliefs are scored exactly.
    """
    belief = np.asarray(belief, np.float64)
    utility, rows = expected_utility(belief, mean), signal_rows(table) if belief.ndim == 1 else None
    if belief.ndim > 1 or (rows is None and table.probs.size <= MOST_NUMBERS):
        return utility + weight * knowledge_gain(belief, mean, table, mass, candidates)
    support, weighted_means = _weighted_means(belief, mean, mass, _considers_all(candidates, table))

    def exact(policies: NDArray[np.int64]) -> Array:
        return utility[policies] + weight * exact_gain(policies, support, weighted_means, table)

    if rows is None:
        scores = utility + weight * joined_gain(support, weighted_means, table)
        n = max(LEAST_EXACT, EXACT_WORK // (weighted_means.size * table.n_signals))
        best = np.sort(np.argsort(-scores, kind="stable")[:n])
        scores[best] = exact(best)
        return scores
    gain, error = rounded_gain(support, weighted_means, rows)
    upper = utility + weight * (gain + error)
    scores = exact_best(upper, float(upper.max()) - 2 * weight * error, exact)
    return np.where(scores == upper, scores - weight * error, scores)


def _considers_all(candidates: Candidates, table: SignalTable) -> bool:
    products = table.n_types * table.n_policies**2 * table.n_signals
    return candidates == "all" or (candidates == "auto" and products <= LARGEST_EXACT)


def _weighted_means(belief: Array, mean: Array, mass: float, every: bool) -> tuple[NDArray[np.int64], Array]:
    """The support of a belief, and its shares times the means of the candidates, (k, n_candidates)."""
    support, share = supported_types(belief, mass)
    means = mean[support] if len(support) < len(belief) else mean
    if not every:
        best = responses(means, share)
        means = means[:, best] if len(best) < means.shape[1] else means
    return support, np.ascontiguousarray(means * share[:, None])


def responses(means: Array, share: Array) -> NDArray[np.int64]:
    """Best responses to each type, `means` (k, n_policies), and to their mixture by `share` (k,); rising."""
    marked = np.zeros(means.shape[1], np.bool_)
    marked[means.argmax(axis=1)] = True
    marked[(share @ means).argmax()] = True
    return np.flatnonzero(marked)


def printed_gain(belief: Array, mean: Array, table: SignalTable) -> Array:
    """v(π) as Eq. 4.6 has it, signals averaged before the maximum: 0 for every policy, up to rounding."""

    def scored(belief: Array) -> Array:
        rows = np.atleast_2d(belief)
        predicted = np.matmul(rows, table.probs)
        # Σ over signals of their probability times the posterior, which is the belief again.
        share = np.divide(predicted, predicted, out=np.zeros_like(predicted), where=predicted > 0)
        after = np.matmul(share, table.probs.transpose(0, 2, 1)) * rows
        gain = (after @ mean).max(axis=-1).T - (rows @ mean).max(axis=-1)[:, None]
        return gain[0] if belief.ndim == 1 else gain

    return in_blocks(belief, table.n_policies * (table.n_types + table.n_signals), scored)
