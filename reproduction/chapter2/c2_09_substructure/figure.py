"""A stack, and a stack with two contacts, whose skeleton contains that of the first (Figure 2.10)."""

from reproduction.chapter2.scenes.scene_example import draw_examples

draw = draw_examples
