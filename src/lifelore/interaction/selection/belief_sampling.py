"""Belief sampling: draw a type from the belief, select its best response. Thesis: §4.5 ("sampling the belief")."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from lifelore.interaction.outcomes.prediction import weighted
from lifelore.interaction.selection.choice import tied_shares
from lifelore.interaction.selection.rule import Array, RuleLibrary, check_generator

MOST_TYPES = 128
"""Number of types up to which running sums of many beliefs are computed as a product."""


@dataclass(frozen=True)
class BeliefSampling:
    """Selects the best response to a type drawn from the belief; also called posterior or Thompson sampling.

    Examples
    --------
    >>> from lifelore import PolicyLibrary
    >>> library = PolicyLibrary.from_means([[9.0, 5.0], [4.0, 8.0]], 2.0)
    >>> BeliefSampling().probabilities(library, np.array([0.3, 0.7])).tolist()
    [0.3, 0.7]
    """

    name: ClassVar[str] = "sampling"
    by_means: ClassVar[bool] = True

    def scores(
        self, library: RuleLibrary, belief: Array, *, generator: np.random.Generator | None = None, **_: Any
    ) -> Array:
        """Mean utilities on the type drawn, (P,) or (k, P)."""
        return library.performance.mean_on(drawn_types(belief, check_generator(self.name, generator)))

    def probabilities(self, library: RuleLibrary, belief: Array, **_: Any) -> Array:
        """Probability of selecting each policy, (P,) or (k, P); rows sum to 1."""
        return weighted(belief, tied_shares(library.performance.mean))


def drawn_types(belief: Array, generator: np.random.Generator) -> Any:
    """Draw a type for each row of beliefs (T,) or (k, T); never a type of belief 0."""
    if belief.ndim == 1:
        held = np.add.accumulate(belief)
        return int(held.searchsorted(generator.random() * held[-1], side="right"))
    n = belief.shape[1]
    held = belief @ _running(n, belief.dtype.char) if n <= MOST_TYPES else np.cumsum(belief, axis=1)
    # In the rows' precision, where comparison is fast, and below the last sum whatever is rounded.
    drawn = np.nextafter((generator.random((len(belief), 1)) * held[:, -1:]).astype(held.dtype), 0)
    return (held > drawn).argmax(axis=1)


@lru_cache(maxsize=4)
def _running(n: int, dtype: str) -> Array:
    """The matrix (n, n) by which rows become their running sums, twice as fast as `cumsum` up to some hundred."""
    return np.triu(np.ones((n, n), dtype))
