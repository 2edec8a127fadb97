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
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.prediction import supported, weighted
from lifelore.interaction.selection.information import predicted_signals, signals_by_type
from lifelore.interaction.selection.rule import (
    Array,
    Deterministic,
    RuleLibrary,
    Variant,
    check_variant,
    weight_of_future,
)
from lifelore.interaction.selection.support import MASS, check_mass, truncated

Candidates = Literal["auto", "responses", "all"]

LARGEST_EXACT = 1 << 22
"""Number of products n_types n_policies² n_signals up to which "auto" considers all policies; more costs time."""
_AT_ONCE = 1 << 20
"""Size of the largest product at once."""


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

    Examples
    --------
    >>> from lifelore import BayesianPolicyReuse, PolicyLibrary
    >>> library = PolicyLibrary.from_means([[9.0, 5.0, 6.0], [4.0, 8.0, 6.0]], 2.0, policies=["A", "B", "C"])
    >>> agent = BayesianPolicyReuse(library, KnowledgeGradient())
    >>> agent.update("A", 4.0)
    >>> library.policies[agent.select()]
    'B'
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
        self, library: RuleLibrary, belief: Array, *, episodes_left: float | None = None, **_: Any
    ) -> Array:
        """Expected utilities plus the weighted gain of learning, (P,) or (k, P)."""
        mean, table = library.performance.mean, library.table(self.n_bins)
        weight = weight_of_future(self.lookahead, episodes_left)
        if self.variant == "thesis":
            gain = printed_gain(belief, mean, table)
        else:
            gain = knowledge_gain(belief, mean, table, self.mass, self.candidates)
        return library.performance.expected(belief) + weight * gain


def knowledge_gain(
    belief: Array, mean: Array, table: SignalTable, mass: float = 1.0, candidates: Candidates = "all"
) -> Array:
    """v(π) of every policy, (P,) or (k, P), at least 0 up to rounding.

    Parameters
    ----------
    belief : (T,) or (k, T) float64
    mean : (T, P) or (k, T, P) float64
    table : SignalTable
    mass : float
        Share of the belief that is used.
    candidates : {"auto", "responses", "all"}
        As for `KnowledgeGradient`.
    """
    belief, laws = truncated(belief, mass), signals_by_type(table)
    among: dict[str, Any] = {}
    products = table.n_types * table.n_policies * laws.shape[-1]
    if candidates == "responses" or (candidates == "auto" and products > LARGEST_EXACT):
        best = responses(belief, mean)
        if belief.ndim == 1:
            mean = mean[:, best]
        else:
            among = {"where": best[..., None], "initial": -np.inf}
    if belief.ndim == 1:
        belief, mean, laws = supported(belief, mean, laws)
    by_candidate = (belief[..., None] * mean).swapaxes(-1, -2)
    step = max(1, _AT_ONCE // (by_candidate[..., 0].size * table.n_signals)) * table.n_signals
    largest = [
        np.matmul(by_candidate, laws[..., at : at + step]).max(axis=-2, **among)
        for at in range(0, laws.shape[-1], step)
    ]
    after = np.concatenate(largest, axis=-1).reshape(*belief.shape[:-1], table.n_policies, -1).sum(axis=-1)
    return after - by_candidate.sum(axis=-1).max(axis=-1)[..., None]


def responses(belief: Array, mean: Array) -> NDArray[np.bool_]:
    """Which policies are best on a type of positive probability, or best now, (P,) or (k, P)."""
    best_now = weighted(belief, mean).argmax(axis=-1)[..., None]
    best = np.where(belief > 0, mean.argmax(axis=-1), best_now)
    found = np.zeros((*belief.shape[:-1], mean.shape[-1]), np.bool_)
    np.put_along_axis(found, np.concatenate([best, best_now], axis=-1), True, axis=-1)
    return found


def printed_gain(belief: Array, mean: Array, table: SignalTable) -> Array:
    """v(π) as Eq. 4.6 has it, signals averaged before the maximum: 0 for every policy, up to rounding."""
    # Σ over signals of their probability times the posterior, which is the belief again.
    share = np.sign(predicted_signals(belief, table))
    after = np.einsum("...tps,...ps->...pt", table.probs, share) * belief[..., None, :]
    return np.matmul(after, mean).max(axis=-1) - weighted(belief, mean).max(axis=-1)[..., None]
