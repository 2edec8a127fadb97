"""What a prior may be conditioned on in a factory: codes of states that hold across tasks, and the features φ.

The features are the ten of φ4 (§3.4.5): the terrain of the 3×3 cells around the robot and the flag *Items*; φ1,
φ2 and φ3 are columns of them. Points show as stations whether or not the task has use for them.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.factory.factory import ASSEMBLED, N_STAGES, RAW, Factory, FactoryTask

FREE, WALL, PROCURE_STATION, ASSEMBLY_STATION = range(4)
TO_PROCURE, TO_ASSEMBLE, NOTHING_LEFT = range(3)
"""Values of *Items*: what is required next. Only completed states, in which nothing is done, have the third."""

FEATURE_NAMES = ("PosUL", "PosUM", "PosUR", "PosML", "PosMM", "PosMR", "PosDL", "PosDM", "PosDR", "Items")
"""Columns of `features`: terrain up, middle, down by left, middle, right (Fig. 3.12), and the flag."""
FEATURE_SIZES = (4,) * 9 + (3,)
PHI = {
    "phi1": ("PosMM", "Items"),
    "phi2": ("PosUM", "PosML", "PosMR", "PosDM"),
    "phi3": ("PosUM", "PosML", "PosMM", "PosMR", "PosDM", "Items"),
    "phi4": FEATURE_NAMES,
}
"""The four sets of §3.4.5."""

ENCODINGS = ("global", "left", "listed", "phase")
"""How a configuration is coded for a prior over states. ``global``: the stage of each of the factory's components,
those of other tasks raw. Relative to the task: ``left``, what is left to do with each of the factory's components
(nothing with those not in the list); ``listed``, the stages in the order of the task's own list; ``phase``, the
flag *Items* alone."""


def terrain(factory: Factory) -> NDArray[np.int8]:
    """(rows, columns) int8: FREE, WALL, PROCURE_STATION or ASSEMBLY_STATION; express routes are free."""
    picture = np.where(factory.floor.state_of < 0, WALL, FREE).astype(np.int8)
    picture[tuple(factory.floor.cells[factory.procure_at].T)] = PROCURE_STATION
    picture[tuple(factory.floor.cells[factory.assemble_at].T)] = ASSEMBLY_STATION
    return picture


def items_flag(task: FactoryTask, configurations: ArrayLike | None = None) -> NDArray[np.int8]:
    """(n,) int8: TO_PROCURE while any item is raw, then TO_ASSEMBLE, at last NOTHING_LEFT; default all."""
    stages = task.stages[_checked(task, configurations)]
    raw, done = (stages == RAW).any(axis=1), (stages == ASSEMBLED).all(axis=1)
    return np.where(raw, TO_PROCURE, np.where(done, NOTHING_LEFT, TO_ASSEMBLE)).astype(np.int8)


def features(task: FactoryTask) -> NDArray[np.int8]:
    """(n_states, 10) int8: the columns `FEATURE_NAMES`, values below `FEATURE_SIZES`."""
    around = np.pad(terrain(task.factory), 1, constant_values=WALL)
    rows, columns = task.factory.floor.cells.T
    seen = [around[rows + i, columns + j] for i in range(3) for j in range(3)]
    cells, flags = np.column_stack(seen), items_flag(task)
    return np.column_stack([np.tile(cells, (len(flags), 1)), np.repeat(flags, len(cells))])


def feature_codes(values: NDArray[np.int8], names: str | Sequence[str] = "phi4") -> NDArray[np.int64]:
    """(n_states,) int64: the chosen columns of `features` as one number each, the last name fastest.

    Parameters
    ----------
    values : (n_states, 10) int8
    names : str or sequence of str
        A key of `PHI`, or names of columns.
    """
    chosen = PHI.get(names, ()) if isinstance(names, str) else tuple(names)
    unknown = [name for name in chosen if name not in FEATURE_NAMES]
    if not chosen or unknown:
        known = ", ".join((*PHI, *FEATURE_NAMES))
        raise NotFoundError(f"names must be a set φ or columns, of {known}; got {unknown or names!r}")
    code = np.zeros(len(values), np.int64)
    for name in chosen:
        column = FEATURE_NAMES.index(name)
        code = code * FEATURE_SIZES[column] + values[:, column]
    return code


def configuration_codes(
    task: FactoryTask, encoding: str = "global", configurations: ArrayLike | None = None
) -> NDArray[np.int64]:
    """(n,) int64: configurations, default all, in one of `ENCODINGS`."""
    chosen = _checked(task, configurations)
    if encoding not in ENCODINGS:
        raise NotFoundError(f"encoding must be one of {', '.join(ENCODINGS)}, got {encoding!r}")
    if encoding == "listed":
        return chosen
    if encoding == "phase":
        return items_flag(task, chosen).astype(np.int64)
    digits = task.stages[chosen].astype(np.int64)
    if encoding == "left":
        digits = ASSEMBLED - digits
    return digits @ N_STAGES ** np.asarray(task.components, np.int64)


def state_contexts(
    task: FactoryTask, encoding: str = "global", configurations: ArrayLike | None = None
) -> NDArray[np.int64]:
    """The code of each state for a prior over states that is carried from task to task.

    Parameters
    ----------
    task : FactoryTask
    encoding : str
        See `ENCODINGS`.
    configurations : (n,) int, optional
        Codes of the states of these alone, in their order; default: all states.

    Returns
    -------
    codes : (n · n_cells,) int64
        Code of the configuration · (rows · columns) + place in the picture. So two factories of one size agree on
        what a place is, however their cells are numbered. Below 2**24 for the thesis's sizes.

    Examples
    --------
    >>> from lifelore.domains.factory.layout import factory
    >>> task = factory().task([2, 5])
    >>> codes = state_contexts(task).reshape(9, -1) // (20 * 20)
    >>> codes[:, 0].tolist() == [i * 3**2 + j * 3**5 for j in range(3) for i in range(3)]
    True
    """
    rows, columns = task.factory.floor.shape
    place = task.factory.floor.cells.astype(np.int64) @ np.array([columns, 1])
    code = configuration_codes(task, encoding, configurations)
    return (code[:, None] * (rows * columns) + place).ravel()


def _checked(task: FactoryTask, configurations: ArrayLike | None) -> NDArray[np.int64]:
    if configurations is None:
        return np.arange(task.n_configurations, dtype=np.int64)
    chosen = np.asarray(configurations, np.int64).ravel()
    if chosen.size and not 0 <= chosen.min() <= chosen.max() < task.n_configurations:
        raise InputError(f"configurations must lie in [0, {task.n_configurations}), got {chosen.tolist()}")
    return chosen
