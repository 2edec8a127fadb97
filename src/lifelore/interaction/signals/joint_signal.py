"""Joint signal: several signals of an episode, independent given the type and the policy."""

from collections.abc import Sequence
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.protocols import SignalModel
from lifelore.interaction.finite_signals.signal_table import SignalTable

Array = NDArray[np.float64]


class JointSignal:
    """Signals that are tuples with a part for each factor; log F is the sum over the factors.

    Parameters
    ----------
    factors : sequence of SignalModel
        At least one, over the same types and policies.

    Raises
    ------
    InputError
        There is no factor, or sizes differ.

    Examples
    --------
    >>> from lifelore.interaction.signals.category_signal import CategorySignal
    >>> coin = CategorySignal([[[0.5, 0.5]], [[0.9, 0.1]]])
    >>> JointSignal([coin, coin]).log_likelihood(0, (0, 1)).round(3).tolist()
    [-1.386, -2.408]
    """

    kind: ClassVar[str] = "joint"
    inner: ClassVar[str] = "factors"
    """Name of the model or models within it."""

    def __init__(self, factors: Sequence[SignalModel]) -> None:
        self.factors: tuple[Any, ...] = tuple(factors)
        if not self.factors:
            raise InputError("factors must be at least one signal model")
        self.n_types: int | None = _shared(self.factors, "n_types")
        self.n_policies: int | None = _shared(self.factors, "n_policies")

    def log_likelihood(self, policy: int, signal: Sequence[Any]) -> Array:
        """Sum of the factors' log likelihoods, (n_types,).

        Raises
        ------
        InputError
            The signal has another number of parts, or a part breaks its factor's rule.
        """
        if not isinstance(signal, Sequence) or len(signal) != len(self.factors):
            raise InputError(f"a joint signal must have {len(self.factors)} parts, got {signal!r:.80}")
        parts = [factor.log_likelihood(policy, part) for factor, part in zip(self.factors, signal, strict=True)]
        return np.sum(parts, axis=0)

    def table(self, n_bins: int = 8) -> SignalTable:
        """All combinations of the factors' signals, about `n_bins` in all, at least two of each factor."""
        if any(not hasattr(factor, "table") for factor in self.factors):
            raise InputError("a factor has no finite alphabet of signals, so the joint signal has none")
        each = max(2, int(round(n_bins ** (1 / len(self.factors)), 9)))
        probs = self.factors[0].table(each).probs
        for factor in self.factors[1:]:
            probs = (probs[..., :, None] * factor.table(each).probs[..., None, :]).reshape(*probs.shape[:2], -1)
        return SignalTable(probs)

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """The model of some types and policies."""
        return type(self)([factor.take(types, policies) for factor in self.factors])


def _shared(factors: tuple[Any, ...], axis: str) -> int | None:
    sizes = {getattr(factor, axis, None) for factor in factors} - {None}
    if len(sizes) > 1:
        raise InputError(f"factors must agree in {axis}, got {sizes}")
    return sizes.pop() if sizes else None
