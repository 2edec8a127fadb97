"""Information-directed sampling, in its deterministic form: the least regret squared for a nat of information.

No κ and no horizon to choose (Russo and Van Roy, 2014). Not in the thesis; as good as expected improvement there.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lifelore.interaction.beliefs.belief import expected_utility
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection.information import mutual_information
from lifelore.interaction.selection.rule import Array, Deterministic
from lifelore.interaction.selection.support import MASS, check_mass

LEAST_INFORMATION = 1e-9
"""Nats below which a signal tells nothing."""


@dataclass(frozen=True)
class InformationDirected(Deterministic):
    """−Δ(π) / √I(π) with Δ(π) = Σ β(τ) max_q E[U | τ, q] − Ũ(π): the order of Δ² / I, smallest first.

    Parameters
    ----------
    mass : float
        Share of the belief whose information is looked at, in (0, 1].
    n_bins : int
        Bins of signals that are numbers.

    Raises
    ------
    InputError
        `mass` lies outside (0, 1].
    """

    mass: float = MASS
    n_bins: int = 8
    name: ClassVar[str] = "information-directed"

    def __post_init__(self) -> None:
        check_mass(self.mass)

    def scores(self, library: PolicyLibrary, belief: Array, **_: Any) -> Array:
        """Minus the root of the information ratio, (..., n_policies)."""
        mean = library.performance.mean
        lost = (np.asarray(belief) @ mean.max(axis=1))[..., None] - expected_utility(belief, mean)
        information = mutual_information(belief, library.table(self.n_bins), self.mass)
        return -np.maximum(lost, 0.0) / np.sqrt(np.maximum(information, LEAST_INFORMATION))
