"""Greedy selection: the largest expected utility under the belief, Ũ(π) = Σ β(τ) E[U | τ, π]. Thesis: Eq. 4.5."""

from dataclasses import dataclass
from typing import Any, ClassVar

from lifelore.interaction.selection.rule import Array, Deterministic, RuleLibrary


@dataclass(frozen=True)
class Greedy(Deterministic):
    """Selects the policy of the largest expected utility; never explores.

    Examples
    --------
    >>> import numpy as np
    >>> from lifelore import PolicyLibrary
    >>> library = PolicyLibrary.from_means([[9.0, 5.0], [4.0, 8.0]], 2.0)
    >>> Greedy().scores(library, np.array([0.5, 0.5])).tolist()
    [6.5, 6.5]
    """

    name: ClassVar[str] = "greedy"
    by_means: ClassVar[bool] = True

    def scores(self, library: RuleLibrary, belief: Array, **_: Any) -> Array:
        """Expected utilities, (P,) or (k, P)."""
        return library.performance.expected(belief)
