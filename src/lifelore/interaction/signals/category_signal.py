"""Category signal: one of a few categories, such as the distance bands of the golf example.

Thesis: §4.4.1, §4.6.1 (Table 4.1).
"""

import json
from collections.abc import Hashable, Sequence
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_bins import joined_table, normal_probs
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.counted_law import CountedLaw, spread_of_counts
from lifelore.interaction.outcomes.law import FixedLaw, Models
from lifelore.interaction.outcomes.log_probability import (
    checked_counts,
    checked_distributions,
    checked_pseudo_count,
    log_of,
)
from lifelore.interaction.outcomes.outcome_rows import check_known, chosen_of, rows_of_samples
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[np.float64]


class CategorySignal:
    """P(category | type, policy) from counts, or exact.

    Parameters
    ----------
    probs : (n_types, n_policies, n_categories) float
        Rows over categories sum to 1; zeros are allowed.
    categories : sequence of hashable, optional
        Names of the categories; signals are then names. By default signals are 0 … n_categories - 1.
    count : float or (n_types, n_policies) float, optional
        Number of signals behind each row, pseudo-counts included; without it rows are exact.

    Raises
    ------
    InputError
        A row is no distribution, or there are too few names or equal names.

    Examples
    --------
    >>> signal = CategorySignal([[[0.9, 0.1]], [[0.2, 0.8]]], categories=["near", "far"])
    >>> signal.log_likelihood(0, "far").round(3).tolist()
    [-2.303, -0.223]
    """

    kind: ClassVar[str] = "category"

    def __init__(
        self, probs: ArrayLike, categories: Sequence[Hashable] | None = None, count: ArrayLike | None = None
    ) -> None:
        self.probs: Array = checked_distributions(probs, "probs", ("n_types", "n_policies", "n_categories"))
        self.n_types, self.n_policies, self.n_categories = self.probs.shape
        self.categories = None if categories is None else tuple(categories)
        names = range(self.n_categories) if self.categories is None else self.categories
        self._place = {name: place for place, name in enumerate(names)}
        if not len(names) == len(self._place) == self.n_categories:
            raise InputError(f"categories must be {self.n_categories} distinct names, got {len(names)}")
        self.totals = None if count is None else checked_counts(count, self.probs.shape[:2])
        self._spread: Spread | None = None
        # Policy and category first: an update reads a row.
        self._log = log_of(np.ascontiguousarray(self.probs.transpose(1, 2, 0)))
        self._log.flags.writeable = False

    @classmethod
    def from_samples(
        cls,
        samples: ArrayLike,
        n_categories: int | None = None,
        pseudo_count: float = 0.5,
        categories: Sequence[Hashable] | None = None,
    ) -> Self:
        """The model fitted to category numbers `samples` (n_types, n_policies, n), NaN where missing.

        Parameters
        ----------
        n_categories : int, optional
            By default the number of `categories`, or else the largest sample plus 1.
        pseudo_count : float
            Added to every category of every pair, ≥ 0; at 0, a category never seen excludes a type for ever.

        Raises
        ------
        InputError
            A pair has no sample, or a sample is no category.
        """
        counted = category_counts(samples, n_categories or (None if categories is None else len(categories)))
        counts = counted + checked_pseudo_count(pseudo_count)
        totals = counts.sum(axis=2)
        return cls(counts / totals[:, :, None], categories, totals)

    def log_likelihood(self, policy: int, signal: Hashable) -> Array:
        """Log probability of the category per type, (n_types,); read only.

        Raises
        ------
        InputError
            There is no such category.
        NotFoundError
            There is no such policy.
        """
        check_known("policy", policy, self.n_policies)
        return self._log[policy, self._place_of(signal)]

    def log_likelihoods(self, policies: Any, signals: Any) -> Array:
        """Log probabilities of many category numbers, (...) and (...) to (..., n_types); without checks."""
        return self._log[policies, signals]

    def places_of(self, signals: Any) -> Any:
        """The numbers of a category, or of categories (k,); InputError where there is no such category."""
        if isinstance(signals, np.ndarray) and self.categories is None and signals.dtype.kind in "iu":
            if signals.size and not 0 <= signals.min() <= signals.max() < self.n_categories:
                raise InputError(f"signals must be category numbers 0 to {self.n_categories - 1}")
            return signals.astype(np.int64, copy=False)
        if isinstance(signals, list) or (isinstance(signals, np.ndarray) and signals.ndim):
            return np.array([self._place_of(signal) for signal in signals], np.int64)
        return self._place_of(signals)

    def law(self, models: Models = "uncertain", *, spread: Spread | None = None, dtype: str = "f8") -> Any:
        """The law of categories given what users have shown; fixed where all is exact, or taken for the truth."""
        if models == "plug-in" or self.totals is None:
            return FixedLaw(self, self.n_types, self.log_likelihoods, self.places_of)
        counts = self.probs * self.totals[:, :, None]
        if self._spread is None:
            self._spread = spread_of_counts(counts, 0.0)
        return CountedLaw(counts, spread or self._spread, self.places_of, dtype=dtype)

    def table(self, n_bins: int = 8) -> SignalTable:
        """All categories where they are at most `n_bins`; otherwise neighbours are joined, as for outcomes."""
        return joined_table(self.probs, n_bins)[1]

    def sample(self, generator: np.random.Generator, type_: int, policy: int, size: Any = None) -> Any:
        """Random category numbers of a pair."""
        return generator.choice(self.n_categories, size, p=self.probs[type_, policy])

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """The model of some types and policies."""
        chosen = np.ix_(chosen_of(types, self.n_types), chosen_of(policies, self.n_policies))
        totals = None if self.totals is None else self.totals[chosen]
        return type(self)(self.probs[chosen], self.categories, totals)

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """Probabilities, the names of the categories as JSON, and the counts behind rows."""
        try:
            names = json.dumps(self.categories)
        except TypeError:
            raise InputError("categories must be texts or numbers to be saved") from None
        totals = {} if self.totals is None else {"totals": self.totals}
        return {"probs": self.probs, "categories": np.frombuffer(names.encode(), np.uint8), **totals}

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        """The model of `to_arrays`, bit for bit."""
        names = json.loads(arrays["categories"].tobytes())
        if "cuts" in arrays:
            # Earlier files may hold bands of normals between common cuts, of which a share are any category.
            probs = normal_probs(arrays["mean"], arrays["deviation"], arrays["cuts"])
            lapse = float(arrays["lapse"])
            return cls((1 - lapse) * probs + lapse / probs.shape[-1], names)
        return cls(arrays["probs"], names, arrays.get("totals"))

    def _place_of(self, signal: Any) -> int:
        try:
            return self._place[signal]
        except (KeyError, TypeError):
            raise InputError(f"signal must be one of {list(self._place)[:20]}, got {signal!r}") from None


def category_counts(samples: ArrayLike, n: int | None) -> Array:
    """How often each of `n` categories came in `samples` of their numbers, (n_types, n_policies, n).

    Parameters
    ----------
    samples : (n_types, n_policies, n_samples) float
        NaN where missing.
    n : int, optional
        By default the largest sample plus 1.

    Raises
    ------
    InputError
        A pair has no sample, or a sample is no category.
    """
    rows = rows_of_samples(samples)
    n = n or int(rows.values.max()) + 1
    number = rows.values.astype(np.int64)
    if (number != rows.values).any() or number.min() < 0 or number.max() >= n:
        raise InputError(f"samples must be category numbers 0 to {n - 1}")
    counted = np.bincount(rows.pair * n + number, minlength=rows.shape[0] * rows.shape[1] * n)
    return counted.reshape(*rows.shape, n).astype(np.float64)
