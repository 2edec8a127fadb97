"""Figure of claim C3.7."""

from collections.abc import Mapping


def draw(result: Mapping):
    from lifelore.experiments.chapter3.feature_curves import draw_feature_curves

    return draw_feature_curves(result)
