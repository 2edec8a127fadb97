"""Expected improvement: expected excess of a policy's utility over the best expected utility. Thesis: §4.5.2.1.

The thesis integrates the density from Uᵗ upwards. That is the *probability* of improvement on Uᵗ and ignores its
size. `variant="thesis"` is as printed; on a fifth of the surveillance tasks it selects a policy of wide outcomes
for ever.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

from lifelore.interaction.beliefs.belief import expected_utility
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection.rule import Array, Deterministic, Variant, check_variant, in_blocks, weighted


@dataclass(frozen=True)
class ExpectedImprovement(Deterministic):
    """Σ β(τ) E[max(U − Uᵗ, 0) | τ, π] with Uᵗ = max Ũ, or as printed Σ β(τ) (1 − F(Uᵗ | τ, π)).

    Parameters
    ----------
    variant : {"standard", "thesis"}

    Raises
    ------
    InputError
        There is no such variant.
    """

    variant: Variant = "standard"
    name: ClassVar[str] = "expected-improvement"

    def __post_init__(self) -> None:
        check_variant(self.variant)

    def scores(self, library: PolicyLibrary, belief: Array, **_: Any) -> Array:
        """Expected improvements (as printed: their probabilities), (..., n_policies)."""
        model = library.performance

        def scored(belief: Array) -> Array:
            best = expected_utility(belief, model.mean).max(axis=-1)
            best = float(best) if belief.ndim == 1 else best
            return weighted(
                belief, model.exceedance(best) if self.variant == "thesis" else model.expected_excess(best)
            )

        return in_blocks(belief, model.n_types * model.n_policies, scored)
