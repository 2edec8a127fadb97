"""Expected improvement of a policy's mean pay, or of its outcome, on the best expected utility. Thesis: §4.5.2.1.

A single outcome exceeds Uᵗ by chance however well its mean is known. The outcome form thus never stops selecting
a policy of wide outcomes: with a single known type, A = 10 ± 1 and B = 6 ± 30, it selects B for ever. The mean pay
exceeds Uᵗ only where something is left to learn.

The thesis integrates the density from Uᵗ upwards. That is the *probability* that an outcome improves on Uᵗ and
ignores its size. `variant="thesis"` is as printed; on a fifth of the surveillance tasks it selects a policy of
wide outcomes for ever.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.prediction import range_of_means, weighted
from lifelore.interaction.selection.choice import TOLERANCE
from lifelore.interaction.selection.rule import Array, Deterministic, RuleLibrary, Variant, check_variant

Improving = Literal["pay", "outcome"]


@dataclass(frozen=True)
class ExpectedImprovement(Deterministic):
    """Σ β(τ) E[max(m(τ, π) − Uᵗ, 0)] with the mean pay m and Uᵗ = max Ũ; or of the outcome U in place of m.

    Where no mean pay exceeds Uᵗ by more than a billionth of the range of mean pays, weighted by the belief, the
    scores are the expected utilities Ũ, so that selection is greedy.

    Parameters
    ----------
    variant : {"standard", "thesis"}
        As printed it is Σ β(τ) P(U > Uᵗ | τ, π), whatever `of` is.
    of : {"pay", "outcome"}
        What improves: the expected pay of a policy, or a single outcome with its noise.

    Raises
    ------
    InputError
        There is no such variant, or `of` is neither of the two.

    Examples
    --------
    >>> from lifelore.interaction.library.policy_library import PolicyLibrary
    >>> library = PolicyLibrary.from_means([[10.0, 6.0]], [[1.0, 30.0]], policies=["A", "B"])
    >>> ExpectedImprovement().probabilities(library, library.prior).tolist()
    [1.0, 0.0]
    >>> ExpectedImprovement(of="outcome").probabilities(library, library.prior).tolist()
    [0.0, 1.0]
    """

    variant: Variant = "standard"
    of: Improving = "pay"
    name: ClassVar[str] = "expected-improvement"

    def __post_init__(self) -> None:
        check_variant(self.variant)
        if self.of not in ("pay", "outcome"):
            raise InputError(f"of must be 'pay' (the expected pay) or 'outcome', got {self.of!r}")

    def scores(self, library: RuleLibrary, belief: Array, **_: Any) -> Array:
        """Expected improvements (as printed: their probabilities), (P,) or (k, P)."""
        model = library.performance
        expected = model.expected(belief)
        best = expected.max(axis=-1)
        if self.variant == "thesis":
            return weighted(belief, model.exceedance(best))
        if self.of == "outcome":
            return weighted(belief, model.expected_excess(best))
        improvement = weighted(belief, model.expected_mean_excess(best))
        some = improvement.max(axis=-1, keepdims=True) > TOLERANCE * range_of_means(model.mean)
        return np.where(some, improvement, expected)
