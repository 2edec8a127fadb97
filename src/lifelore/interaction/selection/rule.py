"""The interface of a selection rule, what a rule reads of a library, and the checks that several rules share.

A rule gives every policy a score under a belief. The policy of the largest score is selected, equals at random.
Under a flat belief many scores are equal up to rounding, so all rules share the tolerance of `choice`.
Thesis: §4.5.

Shapes: T types, P policies. A belief is (T,), or (k, T) with a row for each of k users; scores are (P,) or (k, P).
"""

from typing import ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.prediction import Prediction
from lifelore.interaction.selection.choice import tied_shares

Array = NDArray[np.float64]
Variant = Literal["standard", "thesis"]


class RuleLibrary(Protocol):
    """What a rule reads of a library: `PolicyLibrary`, or the libraries of k users whose models differ."""

    @property
    def n_types(self) -> int: ...

    @property
    def n_policies(self) -> int: ...

    @property
    def performance(self) -> Prediction: ...

    def table(self, n_bins: int) -> SignalTable:
        """Signals from a finite alphabet; InputError where they have no table."""
        ...


class SelectionRule(Protocol):
    """A way to select policies. A rule holds its settings and no state.

    A rule whose score of a policy depends neither on other policies nor on signals has ``by_means = True``, which
    saves time.
    """

    name: ClassVar[str]

    def scores(
        self,
        library: RuleLibrary,
        belief: Array,
        *,
        episodes_left: float | None = None,
        generator: np.random.Generator | None = None,
    ) -> Array:
        """The score of each policy, (P,) or (k, P); the largest is selected.

        Parameters
        ----------
        library : RuleLibrary
        belief : (T,) or (k, T) float64
            Rows sum to 1.
        episodes_left : float, optional
            Number of episodes after this selection.
        generator : numpy generator, optional
            Needed by rules that draw.
        """
        ...

    def probabilities(self, library: RuleLibrary, belief: Array, *, episodes_left: float | None = None) -> Array:
        """Probability of selecting each policy, (P,) or (k, P); rows sum to 1. Call `choice.propensities`."""
        ...


class Deterministic:
    """Base of rules whose scores draw no random numbers: the best policies are equally likely.

    Examples
    --------
    >>> from lifelore import PolicyLibrary
    >>> class Cautious(Deterministic):
    ...     def scores(self, library, belief, **_):
    ...         return library.performance.mean.min(axis=0)
    >>> library = PolicyLibrary.from_means([[9.0, 6.0], [4.0, 5.0]], 2.0)
    >>> Cautious().probabilities(library, np.array([0.5, 0.5])).tolist()
    [0.0, 1.0]
    """

    def probabilities(self, library: RuleLibrary, belief: Array, *, episodes_left: float | None = None) -> Array:
        """Probability of selecting each policy, (P,) or (k, P); rows sum to 1."""
        return tied_shares(self.scores(library, belief, episodes_left=episodes_left))  # pyright: ignore


def check_variant(variant: str) -> None:
    """Raise InputError where the variant is neither ``standard`` nor ``thesis``."""
    if variant not in ("standard", "thesis"):
        raise InputError(f"variant must be 'standard' or 'thesis' (as printed), got {variant!r}")


def weight_of_future(lookahead: float, episodes_left: float | None) -> float:
    """The number of episodes left, or `lookahead` where that is not known; InputError where it is below 0."""
    weight = lookahead if episodes_left is None else episodes_left
    if not weight >= 0:
        raise InputError(f"episodes_left must be at least 0, got {weight}")
    return weight


def check_generator(rule: str, generator: np.random.Generator | None) -> np.random.Generator:
    """The generator; InputError where it is None and the rule draws."""
    if generator is None:
        raise InputError(f"{rule} draws at random; give a generator, e.g. numpy.random.default_rng(0)")
    return generator
