"""Figure of claim C2.7."""

from collections.abc import Mapping

from lifelore.experiments.chapter2.scene_example import draw_examples

CAPTIONS = {
    "stack": "three things",
    "cut": "two things, segmented into three",
    "row": "three in a row",
    "two-on-one": "two on one",
    "real stack": "three real things",
    "real cut": "two real things, segmented into three",
}


def draw(result: Mapping):
    return draw_examples(result, columns=3, captions=CAPTIONS)
