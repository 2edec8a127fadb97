"""Pictures of claim C2.10: a ball on a block by each camera (thesis Fig. 2.2)."""

from collections.abc import Mapping

from lifelore.experiments.chapter2.scenes.scene_example import draw_examples


def draw(result: Mapping):
    return draw_examples(result, columns=2)
