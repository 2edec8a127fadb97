"""The lattice counted by hand."""

import pytest

from lifelore.core.errors import InputError
from lifelore.domains.grids.lattice import lattice


def test_the_thesis_world():
    world = lattice()
    # 21 × 21 inside, less the 10 × 10 cells of even row and column.
    assert world.n_states == 441 - 100
    assert (world.discount, world.goal_reward, world.wall_reward) == (0.95, 100.0, -10.0)
    # 11 passable rows of 21 cells have 20 joints each; so do the columns; each joint is two moves.
    assert (world.neighbour >= 0).sum() == 2 * (11 * 20 + 11 * 20)


def test_seven_by_hand():
    world = lattice(7)
    picture = ["".join(".#"[int(s < 0)] for s in row) for row in world.state_of]
    assert picture == ["#######", "#.....#", "#.#.#.#", "#.....#", "#.#.#.#", "#.....#", "#######"]
    # Of the 21 cells, 4 corners and 12 corridor pieces have 2 moves, 4 edges 3, the centre 4: 48 of 84.
    assert (world.neighbour >= 0).mean() == pytest.approx(48 / 84)


@pytest.mark.parametrize("size", [3, 4, 22, -7, 1003])
def test_sizes_refused(size):
    with pytest.raises(InputError, match="size of a lattice must be odd"):
        lattice(size)
