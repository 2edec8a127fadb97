"""One object wrongly segmented into two, and the relation of its parts (Figure 2.9)."""

from functools import partial

from reproduction.chapter2.scenes.scene_example import draw_examples

draw = partial(draw_examples, layers=("cloud", "relations"))
