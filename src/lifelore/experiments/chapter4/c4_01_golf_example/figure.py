"""Figure of claim C4.1."""

from collections.abc import Mapping


def draw(result: Mapping):
    from lifelore.experiments.chapter4.golf_example import draw_golf_example

    return draw_golf_example(result)
