"""Pictures of claim C2.9: a stack, a stack with two contacts, and a row (thesis Fig. 2.10)."""

from collections.abc import Mapping

from lifelore.experiments.chapter2.scenes.scene_example import draw_examples

CAPTIONS = {
    "stack": "a stack: its skeleton is part of …",
    "two contacts": "… that of a stack with two contacts",
    "row": "a row: alike but for what carries what",
}


def draw(result: Mapping):
    return draw_examples(result, columns=3, captions=CAPTIONS)
