"""Greedy selection: the largest expected utility under the belief, Ũ(π) = Σ β(τ) E[U | τ, π]. Thesis: Eq. 4.5."""

from dataclasses import dataclass
from typing import Any, ClassVar

from lifelore.interaction.beliefs.belief import expected_utility
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection.rule import Array, Deterministic


@dataclass(frozen=True)
class Greedy(Deterministic):
    """Selects the policy of the largest expected utility; never explores."""

    name: ClassVar[str] = "greedy"

    def scores(self, library: PolicyLibrary, belief: Array, **_: Any) -> Array:
        """Expected utilities, (..., n_policies)."""
        return expected_utility(belief, library.performance.mean)
