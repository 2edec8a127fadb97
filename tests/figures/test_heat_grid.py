"""Values are written as they are, coloured by their side of the neutral value."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.figures.heat_grid import draw_heat_grid, frame_cells
from lifelore.figures.style import new_figure


def drawn(values, **how):
    values = np.asarray(values, float)
    axes = new_figure(3, 2).subplots()
    names = [str(i) for i in range(values.shape[0])], [str(i) for i in range(values.shape[1])]
    draw_heat_grid(axes, values, values > 1, *names, **how)
    return axes


def test_texts_and_bold():
    axes = drawn([[0.5, 2.0], [np.nan, 1.0]], neutral=1.0, spread=1.0)
    assert [(t.get_text(), t.get_fontweight()) for t in axes.texts] == [
        ("0.5", "normal"),
        ("2.0", "bold"),
        ("1.0", "normal"),
    ]


def test_colour_is_full_at_the_spread_and_beyond():
    shown = drawn([[0.0, 1.0, 2.0, 9.0]], neutral=1.0, spread=1.0).images[0].get_array()
    assert shown.tolist() == [[-1, 0, 1, 1]]


def test_half_is_as_far_as_double_in_ratios():
    shown = drawn([[0.5, 1.0, 2.0, 8.0]], neutral=1.0, spread=4.0, ratio=True).images[0].get_array()
    np.testing.assert_allclose(shown, [[-0.5, 0, 0.5, 1]])


def test_good_low_turns_the_colours_round():
    high, low = (drawn([[0.0, 2.0]], neutral=1.0, spread=1.0, good=g).images[0] for g in ("high", "low"))
    assert high.cmap(0.0) == low.cmap(1.0) != high.cmap(1.0)


def test_frame():
    (frame,) = drawn([[1.0, 1.0], [1.0, 1.0]], neutral=1.0, spread=1.0, outlined=(1, 0)).patches
    assert (frame.get_xy(), frame.get_width(), frame.get_height()) == ((-0.5, 0.5), 1, 1)


def test_a_frame_without_a_row_is_the_whole_column():
    (frame,) = drawn([[1.0, 1.0], [1.0, 1.0]], neutral=1.0, spread=1.0, outlined=(None, 1)).patches
    assert (frame.get_xy(), frame.get_width(), frame.get_height()) == ((0.5, -0.5), 1, 2)


def test_a_frame_around_a_block_of_cells():
    axes = drawn([[1.0, 1.0, 1.0], [1.0, 1.0, 1.0]], neutral=1.0, spread=1.0)
    frame_cells(axes, (0, 1), (2, 2))
    (frame,) = axes.patches
    assert (frame.get_xy(), frame.get_width(), frame.get_height()) == ((0.5, -0.5), 2, 2)


def test_shapes_must_agree():
    with pytest.raises(InputError, match=r"values and certain must have shape \(1, 1\)"):
        draw_heat_grid(
            new_figure(2, 2).subplots(), [[1.0, 2.0]], [[True, False]], ["a"], ["b"], neutral=0, spread=1
        )
