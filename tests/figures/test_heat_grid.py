"""Values are written as they are, coloured by their side of the neutral value."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.figures.heat_grid import draw_heat_grid
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


def test_shapes_must_agree():
    with pytest.raises(InputError, match=r"values and certain must have shape \(1, 1\)"):
        draw_heat_grid(
            new_figure(2, 2).subplots(), [[1.0, 2.0]], [[True, False]], ["a"], ["b"], neutral=0, spread=1
        )
