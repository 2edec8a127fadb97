"""Two scenes whose networks close to the same hole (Figure 2.6)."""

from reproduction.chapter2.scenes.scene_example import draw_examples

draw = draw_examples
