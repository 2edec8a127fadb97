"""What the prior map computes, by hand, and that both its kinds are drawn."""

import numpy as np
import pytest

from lifelore.domains.grids.grid_world import GridWorld
from lifelore.figures.lives.prior_map import CLOSE_UP, close_up_corner, draw_prior_map, open_moves
from lifelore.figures.style import save_figure


def test_open_moves():
    probs = [[0.25] * 4, [0.5, 0.5, 0, 0], [0, 0, 1, 0]]
    assert open_moves(probs) == pytest.approx([4, 2, 1])


def test_close_up_holds_the_most_decided_cells():
    cells = np.argwhere(np.ones((40, 60), bool))
    decided = (cells[:, 0] >= 20) & (cells[:, 0] < 30) & (cells[:, 1] >= 40) & (cells[:, 1] < 50)
    corner = close_up_corner((40, 60), cells, np.where(decided, 1.0, 4.0), np.ones(len(cells), bool), size=10)
    assert corner.tolist() == [20, 40]


def test_close_up_of_a_flat_world_begins_at_its_corner():
    cells = np.argwhere(np.ones((3, 60), bool))
    corner = close_up_corner((3, 60), cells, np.full(len(cells), 2.0), np.ones(len(cells), bool))
    assert corner.tolist() == [0, 0]


@pytest.mark.parametrize(("shape", "panels"), [((1, 4), 1), ((20, 90), 3), ((70, 5), 3)])
def test_figure_is_drawn(shape, panels, tmp_path):
    world = GridWorld.from_free("hall", np.ones(shape, bool))
    probs = np.random.default_rng(1).dirichlet(np.ones(4), world.n_states)
    counted = np.arange(world.n_states) % 3 > 0
    figure = draw_prior_map(world.shape, world.cells, world.neighbour, probs, counted, cell=0.5, title="A hall")
    assert len(figure.axes) == panels
    assert save_figure(figure, tmp_path / "prior.png").stat().st_size > 5_000


def test_the_close_up_is_framed_in_the_whole():
    world = GridWorld.from_free("hall", np.ones((50, 50), bool))
    probs = np.full((world.n_states, 4), 0.25)
    figure = draw_prior_map(world.shape, world.cells, world.neighbour, probs, np.ones(world.n_states, bool))
    frame = figure.axes[0].patches[-1]
    assert (frame.get_width(), frame.get_height()) == (CLOSE_UP, CLOSE_UP)
