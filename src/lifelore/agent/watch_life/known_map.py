"""A map as far as a life knows it: the places that it has met, and where the action prior sends it from each."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import KIND as PRIOR_KIND
from lifelore.action.priors.action_prior import VERSION as PRIOR_VERSION
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.building_record import remembered_buildings
from lifelore.agent.live import transitions
from lifelore.agent.live.goals.destinations import NamedPlaces
from lifelore.agent.live.lore import PERCEPT_KEY
from lifelore.core.protocols import Record
from lifelore.domains.buildings.registration import inverse, moved
from lifelore.domains.grids.cell_numbers import COLUMN_BITS
from lifelore.domains.grids.grid_world import MOVE_NAMES
from lifelore.memory import Memory

MOST_CELLS = 20_000
"""Largest number of cells, those nearest to `near`; a browser draws more arrows too slowly."""


def known_map(memory: Memory, world: str, near: tuple[int, int] | None = None) -> dict[str, Any] | None:
    """The known places of a world and the prior over moves from each.

    Parameters
    ----------
    memory : Memory
    world : str
        Fingerprint of the world, as the tasks of a life name it.
    near : (row, column), optional
        Of a large map, the places nearest to this cell are given.

    Returns
    -------
    dict or None
        None where memory knows no move in this world; else
        ``shape`` (rows, columns); ``known``, the number of known places; ``untried``, the number of them with
        open moves that were never made; ``cells``, rows (row from the top, column, percept, arrow, untried) where
        percept is a code of `grid_world.PERCEPT`, arrow a number of a row of ``arrows``, -1 where the prior has
        no counts, and untried the number of open moves that were never made; ``arrows``, probabilities of the
        moves north, south, east, west; ``prior``, what the prior is conditioned on: ``"observation"``, or
        null without one; ``names``, the user's destinations in this map: {"name", "at": (row, column)}.
    """
    record = memory.recall(transitions.KIND, world, transitions.VERSION)
    if record is None:
        return None
    rows, columns = (int(side) for side in record.about["shape"])
    numbers, percepts = _known_cells(record)
    row, column = rows - 1 - (numbers >> COLUMN_BITS), numbers & (2**COLUMN_BITS - 1)
    shown = _nearest(row, column, near)
    prior = memory.recall(PRIOR_KIND, PERCEPT_KEY, PRIOR_VERSION)
    arrows, arrow_of = _arrows(prior, percepts[shown])
    untried = _untried(record, numbers, percepts)
    return {
        "shape": [rows, columns],
        "known": len(numbers),
        "untried": int((untried > 0).sum()),
        "cells": np.column_stack([row[shown], column[shown], percepts[shown], arrow_of, untried[shown]]).tolist(),
        "arrows": arrows.round(3).tolist(),
        "prior": prior and "observation",
        "names": _names(memory, record),
    }


def _names(memory: Memory, record: Record) -> list[dict[str, Any]]:
    """The destinations that memory knows by name in the building of a map, by name."""
    about, (rows, columns) = record.about, record.about["shape"]
    cell = about.get("settings", {}).get("cell")
    building = next((one for one in remembered_buildings(memory) if one.key == about.get("building")), None)
    if building is None or cell is None:
        return []
    bottom, left = about["corner"]
    found = []
    for name, point in NamedPlaces(building.key).points(memory).items():
        x, y = moved(inverse(building.frame.origin), np.array([point]))[0] / cell
        row, column = rows - 1 - (int(np.floor(y)) - bottom), int(np.floor(x)) - left
        if 0 <= row < rows and 0 <= column < columns:
            found.append({"name": name, "at": [row, column]})
    return found


def _known_cells(record: Record) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    width = len(MOVE_NAMES) + 1
    met = (record.slots % width == width - 1) & (record.values >= 0)
    return record.slots[met] // width, record.values[met]


def _untried(record: Record, numbers: NDArray[np.int64], percepts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Number of moves from each cell that its percept says are open and that were never made."""
    moves = np.arange(len(MOVE_NAMES))
    slots = numbers[:, None] * (len(MOVE_NAMES) + 1) + moves
    made = np.isin(slots, record.slots[record.values >= 0])
    return (((percepts[:, None] >> moves) & 1).astype(np.bool_) & ~made).sum(axis=1)


def _nearest(row: NDArray[np.int64], column: NDArray[np.int64], near: tuple[int, int] | None) -> NDArray[np.int64]:
    if len(row) <= MOST_CELLS:
        return np.arange(len(row))
    middle = near or (int(row.mean()), int(column.mean()))
    return np.argsort(np.hypot(row - middle[0], column - middle[1]), kind="stable")[:MOST_CELLS]


def _arrows(record: Record | None, percepts: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Different rows of probabilities, and the row of each cell; -1 without counts."""
    if record is None or not len(percepts):
        return np.empty((0, len(MOVE_NAMES))), np.full(len(percepts), -1)
    prior, (codes, of) = ActionPrior.from_record(record, len(MOVE_NAMES)), np.unique(percepts, return_inverse=True)
    return prior.probs(codes), np.where(prior.unseen(codes)[of], -1, of)
