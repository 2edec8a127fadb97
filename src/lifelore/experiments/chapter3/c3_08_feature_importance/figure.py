"""Figure of claim C3.8."""

from collections.abc import Mapping


def draw(result: Mapping):
    from lifelore.experiments.chapter3.feature_bars import draw_feature_bars

    return draw_feature_bars(result)
