"""Stacked bars show the parts of each name as counts or shares."""

import pytest

from lifelore.core.errors import InputError
from lifelore.figures.stacked_bars import draw_stacked_bars
from lifelore.figures.style import house_style, new_figure

COLOURS = {"right": "#009e73", "wrong": "#d55e00"}


def bars(**more):
    with house_style():
        axes = new_figure(4, 3).subplots()
        draw_stacked_bars(axes, ["a", "b"], {"right": [3, 0], "wrong": [1, 5]}, COLOURS, **more)
    return axes


def test_parts_lie_end_to_end():
    axes = bars()
    assert [(bar.get_x(), bar.get_width()) for bar in axes.patches] == [(0, 3), (0, 0), (3, 1), (0, 5)]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["a", "b"]
    assert axes.get_legend_handles_labels()[1] == ["right", "wrong"]


def test_each_part_needs_a_count_for_each_name():
    with house_style(), pytest.raises(InputError, match=r"part 'right' must have shape \(1,\), got \(2,\)"):
        draw_stacked_bars(new_figure(4, 3).subplots(), ["a"], {"right": [1, 2]}, COLOURS)
