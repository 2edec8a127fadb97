"""Rows of outcomes from a table of episodes: a DataFrame or any mapping of columns."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.outcome_model import OutcomeRows


def rows_of_columns(
    frame: Mapping[str, Any], type_: str, policy: str, outcome: str
) -> tuple[OutcomeRows, tuple[str, ...], tuple[str, ...]]:
    """Rows of outcomes, and the names of types and policies in the order of their first rows.

    Raises
    ------
    InputError
        A column is missing, lengths differ, or an outcome is no finite number.
    """
    types, policies, outcomes = (_column(frame, name) for name in (type_, policy, outcome))
    lengths = [len(column) for column in (types, policies, outcomes)]
    if len(set(lengths)) != 1 or not lengths[0]:
        raise InputError(f"columns must share one length of at least 1, got {lengths}")
    try:
        values = np.asarray(outcomes, np.float64)
    except (TypeError, ValueError):
        raise InputError(f"column {outcome!r} must hold numbers") from None
    if not np.isfinite(values).all():
        row = int(np.flatnonzero(~np.isfinite(values))[0])
        raise InputError(f"column {outcome!r} must be finite, row {row} is {values[row]}; leave such rows out")
    type_names, of_type = _places(types)
    policy_names, of_policy = _places(policies)
    rows = OutcomeRows(of_type, of_policy, values, (len(type_names), len(policy_names)))
    return rows, type_names, policy_names


def _column(frame: Mapping[str, Any], name: str) -> list[Any]:
    try:
        return list(frame[name])
    except KeyError:
        raise InputError(f"frame has no column {name!r}; its columns are {list(frame)[:20]}") from None


def _places(column: list[Any]) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    place: dict[str, int] = {}
    places = [place.setdefault(str(name), len(place)) for name in column]
    return tuple(place), np.array(places, np.int64)
