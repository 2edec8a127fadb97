"""Rows of outcomes from a table of episodes: a DataFrame, an Arrow table or any mapping of columns."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.frame_columns import FrameColumns
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows, numbers


def rows_of_columns(
    frame: Any, type_: str, policy: str, outcome: str, weight: str | None = None
) -> tuple[OutcomeRows, tuple[str, ...], tuple[str, ...]]:
    """Rows of outcomes, and the names of types and policies in the order of their first rows.

    Parameters
    ----------
    frame : DataFrame, Arrow table or mapping of str to sequences of one length
        See `FrameColumns`.
    type_, policy, outcome, weight : str
        Names of columns; weights are optional, see `OutcomeRows.with_weights`.

    Raises
    ------
    InputError
        A column is missing, lengths differ, an outcome or weight is no finite number, or a name is missing.
    """
    columns = FrameColumns(frame)
    types, policies, outcomes = (columns.column(name) for name in (type_, policy, outcome))
    lengths = [len(column) for column in (types, policies, outcomes)]
    if len(set(lengths)) != 1 or not lengths[0]:
        raise InputError(f"columns must share one length of at least 1, got {lengths}")
    values = _numbers(outcomes, outcome)
    type_names, of_type = _places(types, type_)
    policy_names, of_policy = _places(policies, policy)
    rows = OutcomeRows(of_type, of_policy, values, (len(type_names), len(policy_names)))
    if weight is not None:
        rows = rows.with_weights(_numbers(columns.column(weight), weight))
    return rows, type_names, policy_names


def _numbers(column: list[Any], name: str) -> NDArray[np.float64]:
    values = numbers(column, f"column {name!r} must hold numbers")
    if not np.isfinite(values).all():
        row = int(np.flatnonzero(~np.isfinite(values))[0])
        raise InputError(f"column {name!r} must be finite, row {row} is {values[row]}; leave such rows out")
    return values


def _places(column: list[Any], name: str) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    if None in column:
        raise InputError(f"column {name!r} must have a name in every row, row {column.index(None)} has none")
    place: dict[str, int] = {}
    places = [place.setdefault(str(word), len(place)) for word in column]
    return tuple(place), np.array(places, np.int64)
