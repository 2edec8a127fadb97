"""Results of a claim as one table: a row for each record, found by its keys; selection, pairing and estimates.

A record is a plain mapping: some entries are keys (method, run, choices of the grid), the others are measures
(a number, or the list of a learning curve). In long form a row of the table is one record and one measure.
"""

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from functools import wraps
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.intervals import t_interval
from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate, ratio_estimate
from reproduction.engine.cell_store import canonical

T = TypeVar("T")

PARTS = ("mean", "deviation", "low", "high")
"""Parts of a summarised curve; `low` and `high` are the ends of its 95 % interval."""
BAND = ("mean", "low", "high")


class ResultsTable:
    """Records by their keys, in the order given.

    Parameters
    ----------
    records : iterable of mapping
    keys : sequence of str
        The entries that are keys; a record without one has None there. Lists count as tuples.

    Examples
    --------
    >>> prior = [{"method": "prior", "run": run, "first": 2.0 * run + 1} for run in range(3)]
    >>> none = [{"method": "none", "run": run, "first": 2.0 * run} for run in range(3)]
    >>> table = ResultsTable(prior + none, keys=("method", "run"))
    >>> table.values("first", method="prior")
    array([1., 3., 5.])
    >>> table.difference("first", {"method": "prior"}, {"method": "none"}).value
    1.0
    """

    def __init__(self, records: Iterable[Mapping[str, Any]], keys: Sequence[str]) -> None:
        self.records = list(records)
        self.keys = tuple(keys)
        self._index: dict[tuple[str, ...], dict[tuple[Hashable, ...], list[int]]] = {}

    @classmethod
    def nested(
        cls, results: Sequence[Mapping[str, Any]], within: str, keys: Sequence[str], outer: Sequence[str] = ()
    ) -> "ResultsTable":
        """The records that stand in the list ``result[within]`` of each result, with the result's `outer` keys."""
        records = (
            {**{key: result[key] for key in outer}, **record} for result in results for record in result[within]
        )
        return cls(records, (*outer, *keys))

    def __len__(self) -> int:
        return len(self.records)

    def select(self, **where: Any) -> "ResultsTable":
        """The records whose keys have these values."""
        return ResultsTable([self.records[i] for i in self._places(where)], self.keys)

    def values(self, measure: str, **where: Any) -> NDArray[np.float64]:
        """A measure of the records found, in their order: (n,), or (n, length) of a curve.

        Raises
        ------
        NotFoundError
            No record has these keys.
        """
        places = self._places(where)
        if not places:
            raise NotFoundError(f"no result has {where}; the keys are {', '.join(self.keys)}")
        return np.array([self.records[i][measure] for i in places], float)

    def paired(
        self, measure: str, first: Mapping[str, Any], second: Mapping[str, Any], **where: Any
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """A measure of two selections, each (n,), run by run.

        Raises
        ------
        InputError
            The selections differ in number.
        """
        one, other = (self.values(measure, **where, **keys) for keys in (first, second))
        if len(one) != len(other):
            raise InputError(f"paired selections must agree in number, got {len(one)} and {len(other)}")
        return one, other

    def mean(self, measure: str, **where: Any) -> Estimate:
        """Mean of a measure with its 95 % interval."""
        return mean_estimate(self.values(measure, **where))

    def difference(self, measure: str, first: Mapping, second: Mapping, **where: Any) -> Estimate:
        """Mean paired difference, the first selection less the second, with its 95 % interval."""
        return difference_estimate(*self.paired(measure, first, second, **where))

    def ratio(self, measure: str, first: Mapping, second: Mapping, **where: Any) -> Estimate:
        """Ratio of the means, the first selection to the second, with its paired 95 % interval."""
        return ratio_estimate(*self.paired(measure, first, second, **where))

    def curve(
        self, measure: str, digits: int | None = None, parts: Sequence[str] = PARTS, **where: Any
    ) -> dict[str, list[float]]:
        """Mean of a curve over the records, its standard deviation and its 95 % t interval, point by point.

        Returns the `parts` asked for, each (length,), rounded to `digits` decimals.
        """
        return curve_of(self.values(measure, **where), digits, parts)

    def _places(self, where: Mapping[str, Any]) -> list[int]:
        unknown = where.keys() - set(self.keys)
        if unknown:
            raise InputError(f"a selection must name keys among {', '.join(self.keys)}, got {', '.join(unknown)}")
        names = tuple(sorted(where))
        if names not in self._index:
            index: dict[tuple[Hashable, ...], list[int]] = {}
            for place, record in enumerate(self.records):
                index.setdefault(tuple(_hashable(record.get(name)) for name in names), []).append(place)
            self._index[names] = index
        return self._index[names].get(tuple(_hashable(where[name]) for name in names), [])


def curve_of(curves: ArrayLike, digits: int | None = None, parts: Sequence[str] = PARTS) -> dict[str, list[float]]:
    """The `parts` asked for of `curves` (n, length): mean, standard deviation, 95 % t interval, each (length,)."""
    curves = np.asarray(curves, float)
    n, mean = len(curves), curves.mean(axis=0)
    deviation = curves.std(axis=0, ddof=1) if n > 1 else np.zeros(curves.shape[1])
    low, high = t_interval(mean, deviation / np.sqrt(n), n - 1) if n > 1 else (mean, mean)
    found = {"mean": mean, "deviation": deviation, "low": low, "high": high}
    return {part: (found[part] if digits is None else np.round(found[part], digits)).tolist() for part in parts}


def having(records: Iterable[Mapping[str, Any]], **values: Any) -> list[Mapping[str, Any]]:
    """The records with these values, in their order.

    Examples
    --------
    >>> having([{"kind": "row", "holes": 1}, {"kind": "ring", "holes": 0}], kind="row")
    [{'kind': 'row', 'holes': 1}]
    """
    return [record for record in records if all(record[key] == value for key, value in values.items())]


def tally(records: Iterable[Mapping[str, Any]], label: str) -> list[dict[str, Any]]:
    """Each different record once, sorted by its values, with its number under `label`.

    Examples
    --------
    >>> tally([{"kind": "row", "holes": 1}, {"kind": "row", "holes": 0}, {"kind": "row", "holes": 1}], "scenes")
    [{'kind': 'row', 'holes': 0, 'scenes': 1}, {'kind': 'row', 'holes': 1, 'scenes': 2}]
    """
    records = list(records)
    keys = [tuple(map(_hashable, record.values())) for record in records]
    first, counts = dict(zip(keys, records, strict=True)), Counter(keys)
    return [{**first[key], label: counts[key]} for key in sorted(counts)]  # type: ignore[type-var]


def computed_once(
    function: Callable[[Mapping[str, Any], Sequence[Mapping[str, Any]]], T],
) -> Callable[[Mapping[str, Any], Sequence[Mapping[str, Any]]], T]:
    """`function` of (settings, results) with its latest value cached: measures and rows rest on the same work."""
    latest: dict[str, T] = {}

    @wraps(function)
    def cached(settings: Mapping[str, Any], results: Sequence[Mapping[str, Any]]) -> T:
        key = canonical([settings, results])
        if key not in latest:
            value = function(settings, results)
            latest.clear()
            latest[key] = value
        return latest[key]

    return cached


def _hashable(value: Any) -> Hashable:
    return tuple(_hashable(item) for item in value) if isinstance(value, (list, tuple)) else value
