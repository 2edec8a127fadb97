"""Pictures of claim C2.6: holes found and not found (thesis Fig. 2.6)."""

from collections.abc import Mapping

from lifelore.experiments.chapter2.scenes.scene_example import draw_examples


def draw(result: Mapping):
    return draw_examples(result, columns=3)
