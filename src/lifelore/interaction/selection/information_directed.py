"""Information-directed selection: the smallest ratio of squared expected regret to information.

The deterministic form of Russo and Van Roy (2014). It has no κ and no horizon to choose. It is not in the thesis;
in the thesis's experiments it does as well as expected improvement.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lifelore.interaction.beliefs.belief import expected_utility
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection.information_bounds import scores_by_information
from lifelore.interaction.selection.rule import Array, Deterministic
from lifelore.interaction.selection.support import MASS, check_mass

LEAST_INFORMATION = 1e-9
"""Least information in nats that scores are divided by."""


@dataclass(frozen=True)
class InformationDirected(Deterministic):
    """−Δ(π) / √I(π) with Δ(π) = Σ β(τ) max_q E[U | τ, q] − Ũ(π): the order of Δ² / I, smallest first.

    Parameters
    ----------
    mass : float
        Share of the belief that is used, in (0, 1].
    n_bins : int
        Number of bins of real-valued signals.

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
        """Minus the root of the information ratio, (..., n_policies); see `scores_by_information`."""
        mean = library.performance.mean
        lost = (np.asarray(belief) @ mean.max(axis=1))[..., None] - expected_utility(belief, mean)
        lost = np.maximum(lost, 0.0)

        def scored(information: Array, some: Any) -> Array:
            return -lost[..., some] / np.sqrt(np.maximum(information, LEAST_INFORMATION))

        # Where there is little to learn, a small error of the information is a large error of the ratio.
        return scores_by_information(belief, library.table(self.n_bins), self.mass, scored, always=True)
