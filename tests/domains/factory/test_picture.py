"""The pictures of factories, looked at by number."""

import numpy as np
import pytest

from lifelore.domains.factory.layout import factory
from lifelore.domains.factory.picture import (
    ASSEMBLE_COLOUR,
    EXPRESS_COLOUR,
    PROCURE_COLOUR,
    RAW_COLOUR,
    ROBOT_COLOUR,
    draw_factory,
)

WORLD = factory("######\n#S+12#\n#..ab#\n######")
SIDE = 640 // 6


def middle(picture, row, column) -> tuple:
    return tuple(picture[row * SIDE + SIDE // 2, column * SIDE + SIDE // 2].tolist())


def test_the_floor_in_the_thesis_colours():
    picture = draw_factory(WORLD)
    assert picture.shape == (4 * SIDE, 6 * SIDE, 3)
    assert picture.dtype == np.uint8
    assert middle(picture, 1, 1) == middle(picture, 1, 2) == EXPRESS_COLOUR
    assert middle(picture, 1, 3) == middle(picture, 1, 4) == PROCURE_COLOUR
    assert middle(picture, 2, 3) == middle(picture, 2, 4) == ASSEMBLE_COLOUR
    assert len({middle(picture, *place) for place in ((0, 0), (2, 1), (1, 2))}) == 3


@pytest.mark.slow
def test_what_is_done_pales_and_shows_in_the_strip():
    task = WORLD.task([1])
    n = WORLD.n_cells
    raw, procured, done = (draw_factory(WORLD, task, configuration * n) for configuration in range(3))
    assert raw.shape[0] == 4 * SIDE + 2 * SIDE
    assert middle(raw, 1, 1) == ROBOT_COLOUR
    assert middle(raw, 1, 3) != PROCURE_COLOUR  # of no use to this task
    assert middle(raw, 1, 4) == PROCURE_COLOUR
    assert middle(procured, 1, 4) != PROCURE_COLOUR
    assert middle(procured, 2, 4) == middle(raw, 2, 4) == ASSEMBLE_COLOUR
    assert middle(done, 2, 4) != ASSEMBLE_COLOUR
    strip = [tuple(picture[5 * SIDE, SIDE + SIDE // 2].tolist()) for picture in (raw, procured, done)]
    assert strip == [RAW_COLOUR, PROCURE_COLOUR, ASSEMBLE_COLOUR]
    assert ROBOT_COLOUR not in {tuple(c) for c in draw_factory(WORLD, task).reshape(-1, 3).tolist()}
