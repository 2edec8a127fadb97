"""Pictures of claim C2.7: stacks, cut objects and controls with their networks (thesis Fig. 2.7)."""

from collections.abc import Mapping

from lifelore.experiments.chapter2.scenes.scene_example import draw_examples

CAPTIONS = {
    "stack": "three objects",
    "cut": "two objects, segmented into three",
    "row": "three in a row",
    "two-on-one": "two on one",
    "real stack": "three real objects",
    "real cut": "two real objects, segmented into three",
}


def draw(result: Mapping):
    return draw_examples(result, columns=3, captions=CAPTIONS)
