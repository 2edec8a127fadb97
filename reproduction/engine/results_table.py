"""Results of a claim as one table: a row for each record, found by its keys; selection, pairing and estimates.

A record is a plain mapping: some entries are keys (method, run, choices of the grid), the others are measures
(a number, or the list of a learning curve). In long form a row of the table is one record and one measure.
"""

from collections import Counter
from collections.abc import Hashable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate, ratio_estimate


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


def curve_of(curves: ArrayLike) -> dict[str, list[float]]:
    """Mean and standard deviation of `curves` (n, length), each (length,), rounded to one decimal."""
    curves = np.asarray(curves, float)
    deviation = curves.std(axis=0, ddof=1) if len(curves) > 1 else np.zeros(curves.shape[1])
    return {"mean": np.round(curves.mean(axis=0), 1).tolist(), "deviation": np.round(deviation, 1).tolist()}


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


def _hashable(value: Any) -> Hashable:
    return tuple(_hashable(item) for item in value) if isinstance(value, (list, tuple)) else value
