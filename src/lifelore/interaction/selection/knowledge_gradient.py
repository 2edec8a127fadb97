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
from lifelore.interaction.selection.rule import Array, Deterministic, Variant, check_variant, in_blocks
from lifelore.interaction.selection.support import MASS, check_mass, supported_types
from lifelore.interaction.selection.type_classes import type_classes

Candidates = Literal["auto", "responses", "all"]

LARGEST_EXACT = 1 << 22
"""Number of products n_types n_policies² n_signals up to which "auto" considers all policies; more costs time: at
this number a decision takes 0.3 ms, beside 0.2 ms with the best responses alone."""


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
        """Expected utilities plus the weighted gain of learning, (..., n_policies)."""
        mean, table = library.performance.mean, library.table(self.n_bins)
        if self.variant == "thesis":
            gain = printed_gain(belief, mean, table)
        else:
            gain = knowledge_gain(belief, mean, table, self.mass, self.candidates)
        weight = self.lookahead if episodes_left is None else episodes_left
        return expected_utility(belief, mean) + weight * gain


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

    products = table.n_types * table.n_policies**2 * table.n_signals
    every = candidates == "all" or (candidates == "auto" and products <= LARGEST_EXACT)

    def gain_of(belief: Array) -> Array:
        support, share = supported_types(belief, mass)
        means = mean[support] if len(support) < len(belief) else mean
        if not every:
            means = means[:, responses(means, share)]
        weighted_means = np.ascontiguousarray(means * share[:, None])
        best = np.empty(table.n_policies)
        best_after_signals(
            weighted_means.astype(table.probs.dtype, copy=False),
            support,
            classes.of_type,
            classes.number,
            table.probs,
            best,
        )
        return best - weighted_means.sum(axis=0).max()

    # The kernel's products are those of SciPy's BLAS, so there is no NumPy twin with the same bits.
    from lifelore.interaction.selection.information_kernels import best_after_signals

    classes = type_classes(table)
    rows = np.asarray(belief, np.float64)
    if rows.ndim == 1:
        return gain_of(rows)
    flat = np.array([gain_of(row) for row in rows.reshape(-1, rows.shape[-1])])
    return flat.reshape(*rows.shape[:-1], table.n_policies)


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
