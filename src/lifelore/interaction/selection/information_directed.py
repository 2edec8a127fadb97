"""Information-directed selection: the smallest ratio of squared expected regret to information.

The deterministic form of Russo and Van Roy (2014). It has no κ and no horizon to choose. It is not in the thesis;
in the thesis's experiments it does as well as expected improvement.

On users whom perhaps no known type fits, agents try policies by `UnknownUsers` instead, since information about
the type ends there. Where models are exact, or taken for the truth, no such users are looked for.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lifelore.interaction.outcomes.prediction import weighted
from lifelore.interaction.selection.information import mutual_information
from lifelore.interaction.selection.rule import Array, Deterministic, RuleLibrary
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

    Examples
    --------
    >>> from lifelore import BayesianPolicyReuse, PolicyLibrary
    >>> library = PolicyLibrary.from_means([[9.0, 5.0, 6.0], [4.0, 8.0, 6.0]], 2.0, policies=["A", "B", "C"])
    >>> agent = BayesianPolicyReuse(library, InformationDirected())
    >>> agent.update("A", 4.0)
    >>> library.policies[agent.select()]
    'B'
    """

    mass: float = MASS
    n_bins: int = 8
    name: ClassVar[str] = "information-directed"
    tries_unknown: ClassVar[bool] = True
    """Whether agents try policies on users whom perhaps no known type fits."""

    def __post_init__(self) -> None:
        check_mass(self.mass)

    def scores(self, library: RuleLibrary, belief: Array, **_: Any) -> Array:
        """Minus the root of the information ratio, (P,) or (k, P)."""
        mean = library.performance.mean
        lost = weighted(belief, mean.max(axis=-1, keepdims=True) - mean)
        information = mutual_information(belief, library.table(self.n_bins), self.mass)
        return -lost / np.sqrt(np.maximum(information, LEAST_INFORMATION))
