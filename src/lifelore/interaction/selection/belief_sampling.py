"""A type drawn from the belief, and the best response to it. Thesis: §4.5 ("sampling the belief")."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection.choice import tied_shares
from lifelore.interaction.selection.rule import Array, check_generator


@dataclass(frozen=True)
class BeliefSampling:
    """Explores by the chance that another type is the true one; also called posterior or Thompson sampling."""

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
        """How likely each policy is to be selected, (..., n_policies); rows sum to 1."""
        return np.asarray(belief) @ tied_shares(library.performance.mean)


def drawn_types(belief: Array, generator: np.random.Generator) -> Any:
    """One type a row, drawn from beliefs (..., n_types); a type of belief 0 is never drawn."""
    cum = np.add.accumulate(belief, axis=-1)
    if cum.ndim == 1:
        return cum.searchsorted(generator.random() * cum[-1], side="right")
    level = generator.random(cum.shape[:-1]) * cum[..., -1]
    return (cum <= level[..., None]).sum(axis=-1)
