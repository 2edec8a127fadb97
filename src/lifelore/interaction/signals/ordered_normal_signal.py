"""Ordered-normal signal: ordered categories as bands of a hidden normal number, such as bands of distance.

A category model of K categories has K - 1 numbers a pair, this model has two, and cut points that all pairs share.
With few runs a pair it predicts better; `CategorySignal` is better where categories have no order, or their shares
no single peak. The category bands of the golf example (§4.6.1, Table 4.1) are such a signal.
"""

import json
from collections.abc import Hashable, Sequence
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.outcome_moments import chosen_of
from lifelore.interaction.signals.category_signal import CategoryModel, category_counts
from lifelore.interaction.signals.ordered_normal_fit import fit_ordered_normals, log_probabilities

Array = NDArray[np.float64]


class OrderedNormalSignal(CategoryModel):
    """P(category | type, policy), where categories are intervals of a normal number between common cut points.

    Parameters
    ----------
    mean, deviation : (n_types, n_policies) float
        Of the hidden number; deviations above 0.
    cuts : (n_categories - 1,) float
        Rising; category k lies between cut points k - 1 and k.
    categories : sequence of hashable, optional
        Names of the categories in their order; signals are then names. By default 0 … n_categories - 1.
    lapse : float
        Share of signals that are any category with equal probability, in [0, 1]. With it, a single surprising
        signal does not exclude a type.

    Raises
    ------
    InputError
        Shapes differ, a deviation is not positive, cut points do not rise, or the lapse lies outside [0, 1].

    Examples
    --------
    >>> signal = OrderedNormalSignal([[0.0], [30.0]], [[10.0], [10.0]], [-5.0, 5.0], ["short", "near", "long"])
    >>> np.exp(signal.log_likelihood(0, "near")).round(3).tolist()
    [0.383, 0.006]
    """

    kind: ClassVar[str] = "ordered-normal"

    def __init__(
        self,
        mean: ArrayLike,
        deviation: ArrayLike,
        cuts: ArrayLike,
        categories: Sequence[Hashable] | None = None,
        lapse: float = 1e-3,
    ) -> None:
        self.mean, self.deviation = np.array(mean, np.float64), np.array(deviation, np.float64)
        self.cuts, self.lapse = checked_cuts(cuts), float(lapse)
        if self.mean.ndim != 2 or not self.mean.size or self.mean.shape != self.deviation.shape:
            shapes = f"{self.mean.shape} and {self.deviation.shape}"
            raise InputError(f"mean and deviation must both be (n_types, n_policies), got {shapes}")
        if not (np.isfinite(self.mean).all() and (self.deviation > 0).all() and np.isfinite(self.deviation).all()):
            raise InputError("mean must be finite, and deviation positive and finite, for every type and policy")
        if not 0 <= self.lapse <= 1:
            raise InputError(f"lapse must lie in [0, 1], got {lapse}")
        probs = np.exp(log_probabilities(self.mean, self.deviation, self.cuts))
        probs /= probs.sum(axis=-1, keepdims=True)
        super().__init__((1 - self.lapse) * probs + self.lapse / probs.shape[-1], categories)

    @classmethod
    def from_samples(
        cls,
        samples: ArrayLike,
        n_categories: int | None = None,
        cuts: ArrayLike | None = None,
        categories: Sequence[Hashable] | None = None,
        *,
        shrinkage: float = 5.0,
        lapse: float = 1e-3,
    ) -> Self:
        """The model fitted to category numbers `samples` (n_types, n_policies, n), NaN where missing.

        Parameters
        ----------
        n_categories : int, optional
            By default the number of `cuts` plus 1, of `categories`, or else the largest sample plus 1.
        cuts : (n_categories - 1,) float, optional
            Known cut points, such as the ends of the bands in yards. By default they are fitted, in an arbitrary
            unit.
        shrinkage : float
            Number of samples of weight of the common deviation in each pair's deviation, above 0.
        lapse : float
            As in the constructor.

        Raises
        ------
        InputError
            A pair has no sample, a sample is no category, or there are fewer than two categories.
        """
        known = None if cuts is None else checked_cuts(cuts)
        named = None if categories is None else len(categories)
        counts = category_counts(samples, n_categories or (named if known is None else known.size + 1))
        n = counts.shape[2]
        if n < 2 or (known is not None and known.size != n - 1):
            given = "" if known is None else f" and {known.size} cuts"
            raise InputError(f"there must be at least 2 categories, and cuts one fewer, got {n} categories{given}")
        if not (shrinkage > 0 and np.isfinite(shrinkage)):
            raise InputError(f"shrinkage must be above 0 and finite, got {shrinkage}")
        fitted = fit_ordered_normals(counts, known, shrinkage)
        return cls(fitted.mean, fitted.deviation, fitted.cuts, categories, lapse)

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """The model of some types and policies."""
        chosen = np.ix_(chosen_of(types, self.n_types), chosen_of(policies, self.n_policies))
        return type(self)(self.mean[chosen], self.deviation[chosen], self.cuts, self.categories, self.lapse)

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """The normals, the cut points, the lapse and, as JSON, the names of the categories."""
        normals = {"mean": self.mean, "deviation": self.deviation, "cuts": self.cuts}
        return {**normals, "lapse": np.array(self.lapse), **super().to_arrays()}

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        """The model of `to_arrays`, bit for bit."""
        names = json.loads(arrays["categories"].tobytes())
        return cls(arrays["mean"], arrays["deviation"], arrays["cuts"], names, float(arrays["lapse"]))


def checked_cuts(cuts: ArrayLike) -> Array:
    """Cut points (n_categories - 1,) as float64; InputError where they are not finite or do not rise."""
    found = np.array(cuts, np.float64)
    if found.ndim != 1 or not found.size or not np.isfinite(found).all() or not (np.diff(found) > 0).all():
        raise InputError(f"cuts must be at least one number, finite and rising, got {cuts!r:.80}")
    return found
