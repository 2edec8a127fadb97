"""Numbers of cells: by hand, and the same on every map of a building."""

import numpy as np

from lifelore.domains.grids.cell_numbers import cells_in_building, cells_of, states_in, states_in_building
from lifelore.domains.grids.grid_world import GridWorld

WORLD = GridWorld.from_free("building", np.array([[1, 1, 0], [0, 1, 1]], np.bool_))


def test_states_and_cells_are_inverse_and_strange_cells_have_no_state():
    assert states_in(WORLD, cells_of(WORLD)).tolist() == [0, 1, 2, 3]
    assert states_in(WORLD, np.array([0, 5, 7 << 20])).tolist() == [-1, -1, -1]


def test_a_map_with_more_columns_on_the_left_has_the_same_numbers():
    wider = GridWorld.from_free("building", np.array([[1, 1, 1, 0], [0, 0, 1, 1]], np.bool_))
    corner = (0, -1)
    own = cells_in_building(wider, corner)
    assert own.tolist() == [-1, 1 << 20, (1 << 20) + 1, 1, 2]
    assert states_in_building(wider, cells_of(WORLD), corner).tolist() == [1, 2, 3, 4]
