"""Arrows stand where mass lies, point the right way, and grow with it."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.quiver import Quiver

from lifelore.core.errors import InputError
from lifelore.figures.lives.prior_arrows import draw_prior
from lifelore.figures.style import LIGHT, PAPER, WALL, new_figure

SHAPE = (2, 3)
CELLS = np.array([(0, 0), (0, 1), (1, 1)])
PROBS = np.array([[0.0, 0.7, 0.3, 0.0], [0.25, 0.25, 0.25, 0.25], [0.97, 0.01, 0.01, 0.01]])


def drawn(counted=(True, True, True), **how):
    axes = new_figure(3, 2).subplots()
    draw_prior(axes, SHAPE, CELLS, PROBS, counted, **how)
    arrows = [c for c in axes.collections if isinstance(c, Quiver)]
    return axes, arrows[0] if arrows else None


def test_arrows_start_in_their_cells_and_point_as_the_moves_do():
    _, arrows = drawn((True, False, True))
    nearest = np.rint(arrows.XY).astype(int).tolist()  # x is the column, y the row
    assert nearest == [[0, 0], [0, 0], [1, 1]]
    assert np.sign(np.column_stack([arrows.U, arrows.V])).tolist() == [
        [0, 1],
        [1, 0],
        [0, -1],
    ]  # y grows downwards


def test_arrows_stay_inside_their_cells_and_grow_with_mass():
    _, arrows = drawn(negligible=0.0)
    tip = arrows.XY + np.column_stack([arrows.U, arrows.V])
    assert (np.abs(tip - np.rint(arrows.XY)) < 0.5).all()
    length = np.hypot(arrows.U, arrows.V)
    mass = PROBS[PROBS > 0]
    order = np.argsort(mass)
    assert (np.diff(length[order]) >= 0).all()
    opacity = arrows.get_facecolor()[:, 3]
    assert (np.diff(opacity[order]) >= 0).all()
    assert length[order[-1]] > 1.1 * length[order[0]]


@pytest.mark.parametrize(("negligible", "n"), [(0.0, 10), (0.05, 7), (0.25, 3), (1.0, 0)])
def test_negligible_mass_has_no_arrow(negligible, n):
    _, arrows = drawn(negligible=negligible)
    assert (len(arrows.U) if arrows else 0) == n


def test_picture_tells_wall_free_and_uncounted_apart():
    axes, _ = drawn((True, False, True))
    picture = axes.images[0].get_array()
    expected = [[PAPER, LIGHT, WALL], [WALL, PAPER, WALL]]
    for cell in np.ndindex(SHAPE):
        assert tuple(picture[cell]) == pytest.approx(to_rgb(expected[cell[0]][cell[1]]))


def test_a_building_of_four_thousand_cells_is_one_collection():
    axes = new_figure(4, 4).subplots()
    cells = np.argwhere(np.ones((64, 64), bool))
    draw_prior(axes, (64, 64), cells, np.full((4096, 4), 0.25), np.ones(4096, bool))
    assert len(axes.collections) == 1
    assert len(axes.collections[0].U) == 4 * 4096


def test_shapes_must_agree():
    with pytest.raises(InputError, match="cells, probs and counted must have shapes"):
        draw_prior(new_figure(2, 2).subplots(), SHAPE, CELLS, PROBS[:2], [True, True])
