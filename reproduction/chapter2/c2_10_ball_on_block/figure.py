"""A ball on a block on the ground with its networks (Figure 2.2)."""

from reproduction.chapter2.scenes.scene_example import draw_examples

draw = draw_examples
