"""Pictures of factories in the colours of the thesis's Figures 3.6 and 3.10: RGB arrays from NumPy alone."""

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.factory.factory import Factory
from lifelore.domains.grids.grid_picture import draw_grid

PROCURE_COLOUR, ASSEMBLE_COLOUR, EXPRESS_COLOUR = (52, 160, 92), (204, 68, 62), (164, 222, 234)


def draw_factory(factory: Factory) -> NDArray[np.uint8]:
    """The floor with its points and routes, (height, width, 3) uint8."""
    picture = draw_grid(factory.floor)
    side = len(picture) // factory.floor.shape[0]
    express = np.flatnonzero(factory.express)
    for colour, places in (
        (EXPRESS_COLOUR, express), (PROCURE_COLOUR, factory.procure_at), (ASSEMBLE_COLOUR, factory.assemble_at),
    ):  # fmt: skip
        for row, column in factory.floor.cells[np.asarray(places, int)] * side:
            # A pixel of floor around each symbol separates it from its neighbours.
            picture[row + 1 : row + side - 1, column + 1 : column + side - 1] = colour
    return picture
