"""Belief entropy: expected utility plus κ for each nat of expected information. Thesis: §4.5.2.2.

The thesis prints the entropy of an expected posterior whose entries sum to more than 1: each type is weighted by
its own likelihood in place of the predictive likelihood. `variant="thesis"` is as printed. The intended quantity
is the expected entropy of the posterior, H(β) − I(π).
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import entropy
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.prediction import range_of_means
from lifelore.interaction.selection.information import mutual_information, predicted_signals
from lifelore.interaction.selection.rule import Array, Deterministic, RuleLibrary, Variant, check_variant
from lifelore.interaction.selection.support import MASS, check_mass

LEAST_PREDICTED = 1e-300
"""Probability below which the printed form takes a signal as impossible: the inverse would not be a number."""


@dataclass(frozen=True)
class BeliefEntropy(Deterministic):
    """Ũ(π) + κ I(π), or as printed Ũ(π) − κ H(β | π).

    Parameters
    ----------
    kappa : float, optional
        Utility of a nat of information, ≥ 0. The range of mean utilities by default.
    variant : {"standard", "thesis"}
    mass : float
        Share of the belief that is used, in (0, 1]; the printed form uses the whole belief.
    n_bins : int
        Number of bins of real-valued signals.

    Raises
    ------
    InputError
        `kappa` is negative, `mass` outside (0, 1], or there is no such variant.

    Examples
    --------
    >>> from lifelore import PolicyLibrary
    >>> library = PolicyLibrary.from_means([[9.0, 5.0], [4.0, 8.0]], 2.0)
    >>> BeliefEntropy(kappa=1.0).scores(library, np.array([0.5, 0.5])).round(2).tolist()
    [6.93, 6.72]
    """

    kappa: float | None = None
    variant: Variant = "standard"
    mass: float = MASS
    n_bins: int = 8
    name: ClassVar[str] = "belief-entropy"

    def __post_init__(self) -> None:
        check_variant(self.variant)
        check_mass(self.mass)
        if self.kappa is not None and not (self.kappa >= 0 and np.isfinite(self.kappa)):
            raise InputError(f"kappa must be at least 0, got {self.kappa}")

    def scores(self, library: RuleLibrary, belief: Array, **_: Any) -> Array:
        """Expected utilities plus κ times the information, (P,) or (k, P)."""
        mean, table = library.performance.mean, library.table(self.n_bins)
        kappa = range_of_means(mean) if self.kappa is None else self.kappa
        utility = library.performance.expected(belief)
        if self.variant == "thesis":
            return utility - kappa * entropy(printed_posterior(belief, table))
        return utility + kappa * mutual_information(belief, table, self.mass)


def printed_posterior(belief: Array, table: SignalTable) -> Array:
    """The thesis's βᵖ(τ) = Σ F(σ | τ)² β(τ) / Σ F β, (P, T) or (k, P, T); its sums exceed 1."""
    predicted = predicted_signals(belief, table)
    inverse = np.divide(1.0, predicted, out=np.zeros_like(predicted), where=predicted > LEAST_PREDICTED)
    return np.einsum("...tps,...ps->...pt", table.probs**2, inverse) * belief[..., None, :]
