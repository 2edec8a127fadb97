"""Colours of interval bars: by group, by name, and by both."""

import pytest
from matplotlib.colors import to_hex

from lifelore.figures.style import new_figure
from reproduction.figures.interval_bars import draw_interval_bars

BARS = {"exact": [{"value": 1.0}, {"value": 2.0}], "learnt": [{"value": 3.0}, None]}


@pytest.mark.parametrize(
    ("colours", "found"),
    [
        ({"exact": "#ff0000", "learnt": "#00ff00"}, ["#ff0000", "#ff0000", "#00ff00"]),
        ({"exact": ["#ff0000", "#0000ff"], "learnt": "#00ff00"}, ["#ff0000", "#0000ff", "#00ff00"]),
        (["#ff0000", "#00ff00"], ["#ff0000", "#ff0000", "#00ff00"]),
    ],
)
def test_colours(colours, found):
    axes = new_figure(3, 2).subplots()
    draw_interval_bars(axes, ["a", "b"], BARS, colours=colours)
    assert [to_hex(bar.get_facecolor()) for bar in axes.patches] == found
