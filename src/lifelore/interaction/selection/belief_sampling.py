"""Belief sampling: draw a type from the belief, select its best response. Thesis: §4.5 ("sampling the belief")."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection.choice import tied_shares
from lifelore.interaction.selection.rule import Array, check_generator


@dataclass(frozen=True)
class BeliefSampling:
    """Selects the best response to a type drawn from the belief; also called posterior or Thompson sampling."""

    name: ClassVar[str] = "sampling"

    def scores(
        self,
        library: PolicyLibrary,
        belief: Array,
        *,
        episodes_left: float | None = None,
        generator: np.random.Generator | None = None,
    ) -> Array:
        """Mean utilities on the type drawn, (..., n_policies)."""
        generator = check_generator(self.name, generator)
        return library.performance.mean[drawn_types(belief, generator)]

    def probabilities(self, library: PolicyLibrary, belief: Array, **_: Any) -> Array:
        """Probability of selecting each policy, (..., n_policies); rows sum to 1."""
        return np.asarray(belief) @ tied_shares(library.performance.mean)


def drawn_types(belief: Array, generator: np.random.Generator) -> Any:
    """Draw a type for each row of beliefs (..., n_types); never a type of belief 0."""
    cum = np.add.accumulate(belief, axis=-1)
    if cum.ndim == 1:
        return cum.searchsorted(generator.random() * cum[-1], side="right")
    level = generator.random(cum.shape[:-1]) * cum[..., -1]
    return (cum <= level[..., None]).sum(axis=-1)
