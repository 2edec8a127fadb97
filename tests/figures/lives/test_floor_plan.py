"""Walls of plans small enough to count, and a scale bar as long as it says."""

import numpy as np

from lifelore.domains.grids.grid_world import GridWorld
from lifelore.figures.lives.floor_plan import draw_floor_plan, draw_scale_bar, wall_segments
from lifelore.figures.style import new_figure


def _length(segments: np.ndarray) -> float:
    return float(np.abs(segments[:, 1] - segments[:, 0]).sum())


def test_a_corridor_has_four_walls():
    world = GridWorld.from_free("corridor", np.ones((1, 4), bool))
    segments = wall_segments(world.cells, world.neighbour)
    assert sorted(map(np.ndarray.tolist, segments)) == [
        [[-0.5, -0.5], [-0.5, 0.5]],
        [[-0.5, -0.5], [3.5, -0.5]],
        [[-0.5, 0.5], [3.5, 0.5]],
        [[3.5, -0.5], [3.5, 0.5]],
    ]


def test_a_wall_between_free_cells_is_drawn_once():
    world = GridWorld.from_free("pair", np.ones((1, 2), bool))
    walled = world.neighbour.copy()
    walled[0, 2] = walled[1, 3] = -1
    assert _length(wall_segments(world.cells, walled)) == _length(wall_segments(world.cells, world.neighbour)) + 1


def test_no_wall_is_lost_or_doubled_by_joining():
    free = np.random.default_rng(5).random((12, 17)) < 0.6
    world = GridWorld.from_free("random", free)
    padded = np.pad(free, 1)
    sides = (padded[1:] != padded[:-1]).sum() + (padded[:, 1:] != padded[:, :-1]).sum()
    segments = wall_segments(world.cells, world.neighbour)
    assert _length(segments) == sides
    assert len(segments) < sides


def test_a_world_without_walls_between_two_cells():
    assert wall_segments([[0, 0]], [[0, 0, 0, 0]]).shape == (0, 2, 2)


def test_scale_bar_is_as_long_as_it_says():
    world = GridWorld.from_free("hall", np.ones((10, 60), bool))
    axes = new_figure(6, 2).subplots()
    draw_floor_plan(axes, world.shape, world.cells, world.neighbour)
    draw_scale_bar(axes, 0.5)
    assert [text.get_text() for text in axes.texts] == ["5 m"]
    assert sum(bar.get_width() for bar in axes.patches) == 10  # cells of half a metre
