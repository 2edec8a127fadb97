"""Figure of claim C2.10."""

from collections.abc import Mapping

from lifelore.experiments.chapter2.scene_example import draw_examples


def draw(result: Mapping):
    return draw_examples(result, columns=2)
