"""Records of a claim's results: plain mappings, some entries of which are keys and the others measures.

A key is a method, a run, a choice of the grid; a measure is a number, or the list of a learning curve.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import NotFoundError

Record = Mapping[str, Any]
POINTS = 100
"""Most points of a stored learning curve; more make result files larger."""


def nested(results: Iterable[Record], within: str, outer: Sequence[str] = ()) -> list[Record]:
    """The records that stand in the list ``result[within]`` of each result, with the result's `outer` keys."""
    return [{**{key: result[key] for key in outer}, **record} for result in results for record in result[within]]


def having(records: Iterable[Record], **values: Any) -> list[Record]:
    """The records with these values, in their order.

    Examples
    --------
    >>> having([{"kind": "row", "holes": 1}, {"kind": "ring", "holes": 0}], kind="row")
    [{'kind': 'row', 'holes': 1}]
    """
    return [record for record in records if values.items() <= record.items()]


def values_of(records: Iterable[Record], measure: str, **where: Any) -> NDArray[np.float64]:
    """A measure of the records with these values, in their order: (n,), or (n, length) of a curve.

    Raises
    ------
    NotFoundError
        There is no such record.

    Examples
    --------
    >>> values_of([{"method": "prior", "first": 2.0 * run} for run in range(3)], "first", method="prior")
    array([0., 2., 4.])
    """
    found = having(records, **where)
    if not found:
        raise NotFoundError(f"no result has {where}")
    return np.array([record[measure] for record in found], float)


def curve_of(curves: ArrayLike) -> dict[str, list[float]]:
    """Mean and standard deviation of `curves` (n, length), each (length,), rounded to one decimal."""
    curves = np.asarray(curves, float)
    deviation = curves.std(axis=0, ddof=1) if len(curves) > 1 else np.zeros(curves.shape[1])
    return {"mean": np.round(curves.mean(axis=0), 1).tolist(), "deviation": np.round(deviation, 1).tolist()}


def in_blocks(curves: NDArray[Any]) -> NDArray[np.float64]:
    """Means of `curves` (n, length) in even blocks, (n, at most `POINTS`)."""
    blocks = np.array_split(curves, min(POINTS, curves.shape[1]), axis=1)
    return np.column_stack([block.mean(axis=1) for block in blocks])
