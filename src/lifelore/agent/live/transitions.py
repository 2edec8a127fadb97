"""Converts a learnt model of a grid to a record of memory and back, also after the place has changed.

A slot is cell · (n_actions + 1) + action. It holds the cell to which the move leads; action = n_actions holds the
percept. Cells are numbered from the lower left corner of the frame, because a changed map may number its states
differently or have a larger picture.
"""

import hashlib

import numpy as np
from numpy.typing import NDArray

from lifelore.core.learning.known_world import UNKNOWN, WorldModel, unknown_world
from lifelore.core.protocols import Record
from lifelore.domains.grids.cell_numbers import BuildingGrid, cells_of, shifted, states_in
from lifelore.domains.grids.grid_world import MOVE_NAMES, Frame, GridWorld

KIND, VERSION = "transitions", 1
SAME_PLACE = 0.8
"""Least share of the stored cells whose percepts are unchanged if two grids on one frame are the same place. Two
different buildings agree in about a third of their cells, most of them open floor."""


def frame_key(world: GridWorld, frame: Frame | None = None) -> str:
    """Hash of the properties that two versions of one place share: frame, actions and settings, not the grid.

    `frame` is that of the place's first map where the world was laid on it; default: the world's own.
    """
    parts = (world.name, frame or world.frame, MOVE_NAMES, sorted(world.about.items()))
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:32]


def model_table(world: GridWorld, model: WorldModel) -> NDArray[np.int64]:
    """Cells to which the moves lead, then the percept: (n_states, n_actions + 1); UNKNOWN where not known."""
    cells = cells_of(world)
    targets = np.where(model.target >= 0, cells[model.target], UNKNOWN)
    return np.column_stack([targets, model.percept])


def to_record(
    world: GridWorld, table: NDArray[np.int64], before: NDArray[np.int64] | int, grid: BuildingGrid | None = None
) -> Record:
    """The entries of `table` that differ from `before`, as a record in which the newest value counts.

    `grid` is that of the building; default: the world's own.
    """
    grid = grid or BuildingGrid(frame_key(world))
    width = table.shape[1]
    state, column = np.nonzero(table != before)
    slots = cells_of(world)[state] * width + column
    order = np.argsort(slots)
    about = {"world": world.name, "states": world.n_states, "frame": grid.frame, "shape": list(world.shape)}
    about |= {"settings": world.about}
    if grid.building is not None:
        about |= {"corner": list(grid.corner), "building": grid.building}
    return Record(KIND, world.fingerprint, VERSION, "newest", slots[order], table[state, column][order], about)


def from_record(world: GridWorld, record: Record | None, corner: tuple[int, int] = (0, 0)) -> WorldModel:
    """The model of this world in a record, without the cells that the world no longer has.

    `corner` is the cell of the world's lower left corner, see `BuildingGrid`.
    """
    model = unknown_world(world.n_states, world.neighbour.shape[1])
    if record is None:
        return model
    width = model.target.shape[1] + 1
    shift = _shift(record, corner)
    state, column = states_in(world, shifted(record.slots // width, shift)), record.slots % width
    known = (state >= 0) & (record.values >= 0)
    moves, percepts = known & (column < width - 1), known & (column == width - 1)
    model.target[state[moves], column[moves]] = states_in(world, shifted(record.values[moves], shift))
    model.percept[state[percepts]] = record.values[percepts]
    return model


def forget_changed(world: GridWorld, model: WorldModel) -> None:
    """Forget the moves of the cells whose remembered percept is not that of the world's map."""
    changed = model.percept != world.percepts
    model.target[changed] = UNKNOWN
    model.percept[changed] = UNKNOWN


def forget_contradicted(world: GridWorld, model: WorldModel) -> None:
    """Forget the moves of another robot's model that the map of this world does not have.

    A robot of another radius has other cells with open sides: its moves hold where this map has them, too. Where
    the surroundings are the same for both, its refused moves hold, too.
    """
    changed = (model.percept != UNKNOWN) & (model.percept != world.percepts)
    there = np.where(world.neighbour < 0, np.arange(world.n_states)[:, None], world.neighbour)
    model.target[changed[:, None] & (model.target != there)] = UNKNOWN
    model.percept[changed] = world.percepts[changed]


def agreement(world: GridWorld, record: Record, corner: tuple[int, int] = (0, 0)) -> float:
    """Share of the record's cells whose percepts are unchanged in this world, in [0, 1]."""
    width = world.neighbour.shape[1] + 1
    percepts = (record.slots % width == width - 1) & (record.values >= 0)
    state = states_in(world, shifted(record.slots[percepts] // width, _shift(record, corner)))
    same = (state >= 0) & (world.percepts[state] == record.values[percepts])
    return float(same.mean()) if same.size else 0.0


def has_entered(record: Record, cells: NDArray[np.int64]) -> bool:
    """Whether a record knows the percepts of all these cells, which are counted in its building's grid."""
    width = len(MOVE_NAMES) + 1
    known = record.slots[(record.slots % width == width - 1) & (record.values >= 0)] // width
    return bool(np.isin(cells, cells_from(record, known, (0, 0))).all())


def cells_from(record: Record, cells: NDArray[np.int64], corner: tuple[int, int]) -> NDArray[np.int64]:
    """Numbers of a record's cells counted from a world's `corner`; -1 for cells below or left of it."""
    return shifted(cells, _shift(record, corner))


def _shift(record: Record, corner: tuple[int, int]) -> tuple[int, int]:
    """Rows and columns from a record's lower left corner to that of a world."""
    row, column = record.about.get("corner", (0, 0))
    return row - corner[0], column - corner[1]
