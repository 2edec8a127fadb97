"""Myopic value of perfect information: the expected gain of the next choice if a policy's mean pay became known.

    VPI(π) = Σ_τ β(τ) E[max(m(τ, π) − Uᵗ, 0)]     where π is not the best policy, π₁
    VPI(π₁) = Σ_τ β(τ) E[max(U₂ − m(τ, π₁), 0)]    with the second best expected utility U₂

Knowing π's mean pay m changes the choice only where another policy turns out to exceed the best one, or the best
one to fall below the second. A policy has the score Ũ(π) + VPI(π), which weighs the gain against the cost
Uᵗ − Ũ(π) of a worse choice. The thesis names this rule beside the knowledge gradient and prints no formula
(§4.5.2.3). This is that of Dearden, Friedman and Russell, Bayesian Q-learning (1998). Their values are sums over
all that follows; here a mean pay is that of one episode, so the gain counts once for each episode that is left.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.prediction import Prediction, weighted
from lifelore.interaction.selection.rule import Array, Deterministic, RuleLibrary, weight_of_future

Counted = Literal["episodes", "once"]


@dataclass(frozen=True)
class ValueOfPerfectInformation(Deterministic):
    """Ũ(π) + (K − t) VPI(π), or Ũ(π) + VPI(π).

    The rule reads no signals: one episode tells less than perfect information, and how much less it does not ask.

    Parameters
    ----------
    counted : {"episodes", "once"}
        How often the gain counts: in each episode that is left, or once.
    lookahead : float
        Number of episodes left, K − t, where the agent has no horizon; ≥ 0.

    Raises
    ------
    InputError
        `lookahead` is negative or not finite, or `counted` is neither of the two.

    Examples
    --------
    Of two equally likely types, A pays 5 on both; B pays 0 on the first and 8 on the second, 4 on average. Knowing
    B's pay gains 3 in half of the cases, and knowing A's pay gains nothing.

    >>> from lifelore.interaction.library.policy_library import PolicyLibrary
    >>> library = PolicyLibrary.from_means([[5.0, 0.0], [5.0, 8.0]], 1.0, policies=["A", "B"])
    >>> ValueOfPerfectInformation(counted="once").scores(library, library.prior).tolist()
    [5.0, 5.5]
    """

    counted: Counted = "episodes"
    lookahead: float = 50.0
    name: ClassVar[str] = "value-of-perfect-information"

    def __post_init__(self) -> None:
        if self.counted not in ("episodes", "once"):
            raise InputError(f"counted must be 'episodes' (each that is left) or 'once', got {self.counted!r}")
        if not (self.lookahead >= 0 and np.isfinite(self.lookahead)):
            raise InputError(f"lookahead must be at least 0 and finite, got {self.lookahead}")

    def scores(
        self, library: RuleLibrary, belief: Array, *, episodes_left: float | None = None, **_: Any
    ) -> Array:
        """Expected utilities plus the gain of perfect information, (P,) or (k, P)."""
        weight = weight_of_future(self.lookahead, episodes_left)
        expected = library.performance.expected(belief)
        gain = perfect_gain(library.performance, belief, expected)
        return expected + (1.0 if self.counted == "once" else weight) * gain


def perfect_gain(outcomes: Prediction, belief: Array, expected: Array) -> Array:
    """VPI(π) of each policy, (P,) or (k, P), ≥ 0; 0 where there is a single policy.

    Parameters
    ----------
    outcomes : Prediction
    belief : (T,) or (k, T) float64
    expected : (P,) or (k, P) float64
        Ũ under this belief.
    """
    if expected.shape[-1] < 2:
        return np.zeros_like(expected)
    ranked, best = np.sort(expected, axis=-1), expected.argmax(axis=-1)[..., None]
    first, second = ranked[..., -1], ranked[..., -2]
    gain = weighted(belief, outcomes.expected_mean_excess(first))
    # E[max(U₂ − m, 0)] = E[max(m − U₂, 0)] + U₂ − E[m], and E[m] of the best policy is Uᵗ.
    above_second = weighted(belief, outcomes.expected_mean_excess(second))
    of_best = np.take_along_axis(above_second, best, axis=-1) + (second - first)[..., None]
    np.put_along_axis(gain, best, of_best, axis=-1)
    return np.maximum(gain, 0.0)
