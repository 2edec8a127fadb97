"""The picture of a world, looked at by number."""

import numpy as np

from lifelore.domains import GridWorld, OccupancyMap, building_from_map
from lifelore.domains.grids.grid_picture import AGENT_COLOUR, GOAL_COLOUR, draw_grid

FLOOR = np.array([[True, True, True], [True, False, True]])


def colours(picture) -> set:
    return {tuple(colour) for colour in picture.reshape(-1, 3).tolist()}


def test_cells_goal_and_agent_are_where_they_belong():
    world = GridWorld.from_free("test", FLOOR)
    picture = draw_grid(world, agent=0, goal=2)
    side = 640 // 3
    assert picture.shape == (2 * side, 3 * side, 3)
    assert picture.dtype == np.uint8
    centre = side // 2
    assert tuple(picture[centre, centre]) == AGENT_COLOUR
    assert tuple(picture[centre, centre + 2 * side]) == GOAL_COLOUR
    assert len({tuple(picture[centre + side, centre + k * side].tolist()) for k in range(3)}) == 2
    assert colours(draw_grid(world)) < colours(picture)


def test_a_wall_between_two_cells_is_a_line():
    state = np.zeros((4, 4), np.uint8)
    joined = building_from_map(OccupancyMap(state, 0.1), 0.2, 0.0)
    state = state.copy()
    state[2:, 1] = 1  # cuts the two lower cells from each other
    cut = building_from_map(OccupancyMap(state, 0.1), 0.2, 0.0)
    assert cut.shape == joined.shape == (2, 2)
    changed = np.argwhere((draw_grid(joined) != draw_grid(cut)).any(axis=2))
    assert changed[:, 0].min() == 320  # only in the lower half
    assert changed[:, 1].min() == 319  # two pixels wide, in the middle
    assert changed[:, 1].max() == 320
