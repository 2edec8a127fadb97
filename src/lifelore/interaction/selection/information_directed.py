"""Information-directed selection: the smallest ratio of squared expected regret to information.

The deterministic form of Russo and Van Roy (2014). It has no κ and no horizon to choose. It is not in the thesis;
in the thesis's experiments it does as well as expected improvement.

Information about the type ends once the type is known, but a user's own mean pays may still differ from the type's
where models are uncertain. With `trials`, a policy that is not the best now is tried while its own mean repays it:

    n G(π) > max Ũ − Ũ(π)      G(π) = E[max(m' − max Ũ, 0)], m' the mean pay that is expected after a trial

n is the number of episodes that the trial serves: twice as many as have passed, since a user who has stayed will
stay, at most 50 and those that are left. That is the knowledge gradient of independent normal means (Frazier and
others, 2008). Where mean pays are exact, G is 0.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lifelore.interaction.outcomes.prediction import Prediction, normal_excess, weighted
from lifelore.interaction.selection.information import mutual_information
from lifelore.interaction.selection.rule import Array, Deterministic, RuleLibrary
from lifelore.interaction.selection.support import MASS, check_mass

LEAST_INFORMATION = 1e-9
"""Least information in nats that scores are divided by."""
AHEAD = 2.0
"""Number of episodes that a trial serves, for each outcome that the user has shown; more explores longer."""
LARGEST_AHEAD = 50.0
"""Largest number of episodes that a trial serves; more explores longer, also after a type has changed."""


@dataclass(frozen=True)
class InformationDirected(Deterministic):
    """−Δ(π) / √I(π) with Δ(π) = Σ β(τ) max_q E[U | τ, q] − Ũ(π): the order of Δ² / I, smallest first.

    Parameters
    ----------
    mass : float
        Share of the belief that is used, in (0, 1].
    n_bins : int
        Number of bins of real-valued signals.
    trials : bool
        Whether policies are also tried for their own mean pay, where models are uncertain. Together with
        `with_unknown_type` it serves users whom no type fits; known users pay for it.

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
    trials: bool = False
    name: ClassVar[str] = "information-directed"

    def __post_init__(self) -> None:
        check_mass(self.mass)

    def scores(
        self, library: RuleLibrary, belief: Array, *, episodes_left: float | None = None, **_: Any
    ) -> Array:
        """Minus the root of the information ratio; the net gain of a trial where positive; (P,) or (k, P)."""
        outcomes = library.performance
        expected = outcomes.expected(belief)
        best = (belief * outcomes.mean.max(axis=-1)).sum(axis=-1)[..., None]
        lost = np.maximum(best - expected, 0.0)
        information = mutual_information(belief, library.table(self.n_bins), self.mass)
        scores = -lost / np.sqrt(np.maximum(information, LEAST_INFORMATION))
        if not self.trials or outcomes.mean_variance is None:
            return scores
        most = LARGEST_AHEAD if episodes_left is None else min(episodes_left, LARGEST_AHEAD)
        ahead = np.minimum(AHEAD * np.asarray(outcomes.n_shown)[..., None], most)
        cost = expected.max(axis=-1, keepdims=True) - expected
        net = ahead * gain_of_trial(outcomes, belief, expected) - cost
        return np.where((net > 0) & (cost > 0), net, scores)


def gain_of_trial(outcomes: Prediction, belief: Array, expected: Array) -> Array:
    """What another outcome of each policy gains an episode, by the policy's own mean pay, (P,) or (k, P), ≥ 0.

    That is G(π) = E[max(m' − Uᵗ, 0)] with Uᵗ = max Ũ; m' is taken as normal around Ũ. Types are taken as known.

    Parameters
    ----------
    outcomes : Prediction
        With `mean_variance`.
    belief : (T,) or (k, T) float64
    expected : (P,) or (k, P) float64
        Ũ under this belief.
    """
    assert outcomes.mean_variance is not None
    unknown = weighted(belief, outcomes.mean_variance)
    deviation = np.sqrt(weighted(belief, outcomes.deviation**2))
    return normal_excess(expected - expected.max(axis=-1, keepdims=True), unknown / deviation)
