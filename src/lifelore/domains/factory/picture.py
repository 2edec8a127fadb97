"""Pictures of factories in the colours of the thesis's Figures 3.6 and 3.10: RGB arrays from NumPy alone."""

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.factory.factory import ASSEMBLED, PROCURED, RAW, Factory, FactoryTask
from lifelore.domains.grids.grid_picture import draw_grid

PROCURE_COLOUR, ASSEMBLE_COLOUR, EXPRESS_COLOUR = (52, 160, 92), (204, 68, 62), (164, 222, 234)
ROBOT_COLOUR, RAW_COLOUR = (36, 62, 128), (226, 226, 222)
_PALE = 0.72
"""How far a point of no use to the task, or used already, is blended towards white."""


def draw_factory(factory: Factory, task: FactoryTask | None = None, state: int | None = None) -> NDArray[np.uint8]:
    """The floor with its points and routes; with a task and its state also the robot and what is done.

    Parameters
    ----------
    factory : Factory
    task : FactoryTask, optional
        Points that the task has no use for, or no more, are pale. A strip below the floor has one square for each
        component of the list: grey while raw, green once procured, red once assembled.
    state : int, optional
        State of `task`.

    Returns
    -------
    picture : (height, width, 3) uint8
    """
    picture = draw_grid(factory.floor)
    side = len(picture) // factory.floor.shape[0]
    for cell in np.flatnonzero(factory.express):
        _fill(picture, factory, int(cell), EXPRESS_COLOUR, side)
    stages = _stages(task, state)
    for colour, points, stage in (
        (PROCURE_COLOUR, factory.procure_at, RAW),
        (ASSEMBLE_COLOUR, factory.assemble_at, PROCURED),
    ):
        for component, cell in enumerate(points):
            useful = task is None or (component in stages and stages[component] <= stage)
            _fill(picture, factory, int(cell), colour if useful else _paler(colour), side)
    if task is None:
        return picture
    if state is not None:
        _draw_robot(picture, factory, state % factory.n_cells, side)
    return np.concatenate([picture, _strip(list(stages.values()), picture.shape[1], side)])


def _stages(task: FactoryTask | None, state: int | None) -> dict[int, int]:
    if task is None:
        return {}
    configuration = 0 if state is None else state // task.factory.n_cells
    return dict(zip(task.components, task.stages[configuration].tolist(), strict=True))


def _paler(colour: tuple[int, int, int]) -> tuple[int, int, int]:
    red, green, blue = (round(part + (255 - part) * _PALE) for part in colour)
    return red, green, blue


def _fill(picture: NDArray[np.uint8], factory: Factory, cell: int, colour, side: int) -> None:
    row, column = factory.floor.cells[cell] * side
    # A pixel of floor around each symbol separates it from its neighbours.
    picture[row + 1 : row + side - 1, column + 1 : column + side - 1] = colour


def _draw_robot(picture: NDArray[np.uint8], factory: Factory, cell: int, side: int) -> None:
    offset = np.arange(side) - (side - 1) / 2
    from_centre = offset[:, None] ** 2 + offset**2
    row, column = factory.floor.cells[cell] * side
    square = picture[row : row + side, column : column + side]
    square[from_centre <= (0.42 * side) ** 2] = 255
    square[from_centre <= (0.36 * side) ** 2] = ROBOT_COLOUR


def _strip(stages: list[int], width: int, side: int) -> NDArray[np.uint8]:
    colours = {RAW: RAW_COLOUR, PROCURED: PROCURE_COLOUR, ASSEMBLED: ASSEMBLE_COLOUR}
    strip = np.full((2 * side, width, 3), 255, np.uint8)
    for place, stage in enumerate(stages):
        left = side + 2 * side * place
        strip[side // 2 : side // 2 + side, left : left + side] = colours[stage]
    return strip
