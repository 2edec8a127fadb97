"""Curves of returns and the episodes to 80 %: what is drawn is what was given."""

from lifelore.figures.style import new_figure
from reproduction.chapter3.figures.reward_curves import MethodCurve, draw_return_curves

RESULT = {
    "settings": {"episodes": 1000, "schedules": [[0.1, 1.0, 0.1]]},
    "measured": {"optimal_return": {"value": 54.0}},
    "rows": [{"curve_edges": [0, 1, 60]}],
}
BAND = {"mean": [0.0, 1.0], "low": [-1.0, 0.0], "high": [1.0, 2.0]}


def test_bars_stand_in_order_and_mark_the_cap_and_asides_have_no_band():
    figure = new_figure(3, 4).subfigures()
    methods = [
        MethodCurve("Q-learning", "#000000", BAND, {"value": 400, "ci95": [350, 450]}),
        MethodCurve("other", "#ffffff", BAND, {"value": 1000, "ci95": None}, is_aside=True),
    ]
    draw_return_curves(figure, RESULT, lambda schedule: methods, bars=0.3, ncols=2)
    above, below = figure.axes
    assert [bar.get_width() for bar in below.patches] == [400, 1000]
    assert [text.get_text() for text in below.texts] == ["400", "≥ 1000"]
    assert below.patches[0].get_y() < below.patches[1].get_y()
    assert below.yaxis_inverted()
    assert len(above.collections) == 1
    assert 54.0 in [line.get_ydata()[0] for line in above.lines]
    assert above.get_title() == "ε = 0.1"
