"""Bars stand at their values, groups side by side, coloured by group or by name."""

import pytest
from matplotlib.colors import to_hex

from lifelore.figures.style import new_figure
from reproduction.figures.interval_bars import draw_interval_bars


def drawn(groups, **how):
    axes = new_figure(3, 2).subplots()
    draw_interval_bars(axes, ["first", "second"], groups, **how)
    return axes


def test_groups_stand_side_by_side_and_none_leaves_its_place_empty():
    one, other = [{"value": 1.0, "ci95": [0.5, 2.0]}, {"value": 3.0, "ci95": None}], [{"value": 4.0}, None]
    axes = drawn({"a": one, "b": other}, horizontal=False)
    assert [bar.get_height() for bar in axes.patches] == [1.0, 3.0, 4.0]
    middles = [bar.get_x() + bar.get_width() / 2 for bar in axes.patches]
    assert middles == pytest.approx([-0.2, 0.8, 0.2])
    assert [list(line.get_ydata()) for line in axes.lines] == [[0.5, 2.0]]


BARS = {"exact": [{"value": 1.0}, {"value": 2.0}], "learnt": [{"value": 3.0}, None]}


@pytest.mark.parametrize(
    ("colours", "found"),
    [
        ({"exact": "#ff0000", "learnt": "#00ff00"}, ["#ff0000", "#ff0000", "#00ff00"]),
        (["#ff0000", "#00ff00"], ["#ff0000", "#ff0000", "#00ff00"]),
    ],
)
def test_colours(colours, found):
    axes = drawn(BARS, colours=colours)
    assert [to_hex(bar.get_facecolor()) for bar in axes.patches] == found
