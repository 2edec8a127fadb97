"""The interface of a selection rule, what a rule reads of a library, and the sums that several rules share.

A rule gives every policy a score under a belief. The policy of the largest score is selected, equals at random.
Under a flat belief many scores are equal up to rounding, so all rules share the tolerance of `choice`.
Thesis: §4.5.

Shapes: T types, P policies. A belief is (T,), or (k, T) with a row for each of k users; scores are (P,) or (k, P).
"""

from typing import Any, ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.selection.choice import tied_shares

Array = NDArray[np.float64]
Variant = Literal["standard", "thesis"]


class RuleOutcomes(Protocol):
    """The outcome model as rules read it: the same for all users, or a leading axis of k users on every array."""

    @property
    def mean(self) -> Array:
        """E[U | type, policy], (T, P) or (k, T, P)."""
        ...

    def mean_on(self, types: Any) -> Array:
        """Mean outcomes on a type for each row, () or (k,) int to (P,) or (k, P)."""
        ...

    def expected(self, belief: Array) -> Array:
        """Ũ(π) = Σ β(τ) E[U | τ, π] (Eq. 4.5) of beliefs (T,) or (k, T), (P,) or (k, P)."""
        ...

    def density(self, value: Any) -> Array:
        """Density of `value`, a number or (k,), for every pair, (T, P) or (k, T, P)."""
        ...

    def exceedance(self, threshold: Any) -> Array:
        """P(U > threshold), shapes as for `density`."""
        ...

    def expected_excess(self, threshold: Any) -> Array:
        """E[max(U - threshold, 0)], shapes as for `density`."""
        ...

    def expected_mean_excess(self, threshold: Any) -> Array:
        """E[max(m - threshold, 0)] of a pair's mean m under what is unknown about it, shapes as for `density`."""
        ...


class RuleLibrary(Protocol):
    """What a rule reads of a library: `PolicyLibrary`, or the libraries of k users whose models differ."""

    @property
    def n_types(self) -> int: ...

    @property
    def n_policies(self) -> int: ...

    @property
    def performance(self) -> RuleOutcomes: ...

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
    """Base of rules whose scores draw no random numbers: the best policies are equally likely."""

    def probabilities(self, library: RuleLibrary, belief: Array, *, episodes_left: float | None = None) -> Array:
        """Probability of selecting each policy, (P,) or (k, P); rows sum to 1."""
        return tied_shares(self.scores(library, belief, episodes_left=episodes_left))  # pyright: ignore


def weighted(belief: Array, values: Array) -> Array:
    """Σ β(τ) v(τ, ·), (n,) or (k, n).

    Parameters
    ----------
    belief : (T,) or (k, T) float64
    values : (T, n) float64, or (k, T, n) with values of their own for each row of the belief
    """
    if values.ndim > 2:
        return np.matmul(belief[..., None, :], values)[..., 0, :]
    if belief.ndim == 1:
        belief, values = supported(belief, values)
    return belief @ values


def supported(belief: Array, *values: Array) -> tuple[Array, ...]:
    """A belief (T,) and rows of `values` (T, n) for its types of positive probability, where these are few."""
    some = belief.nonzero()[0]
    return (belief, *values) if 2 * len(some) > len(belief) else tuple(each[some] for each in (belief, *values))


def range_of_means(mean: Array) -> Array:
    """Largest less smallest mean of a library, (1,), or of each user's, (k, 1)."""
    return np.ptp(mean, axis=(-2, -1))[..., None]


def check_variant(variant: str) -> None:
    """Raise InputError where the variant is neither ``standard`` nor ``thesis``."""
    if variant not in ("standard", "thesis"):
        raise InputError(f"variant must be 'standard' or 'thesis' (as printed), got {variant!r}")


def check_generator(rule: str, generator: np.random.Generator | None) -> np.random.Generator:
    """The generator; InputError where it is None and the rule draws."""
    if generator is None:
        raise InputError(f"{rule} draws at random; give a generator, e.g. numpy.random.default_rng(0)")
    return generator
