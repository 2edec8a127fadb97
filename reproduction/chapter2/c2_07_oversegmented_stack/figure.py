"""A stack of three, and two objects wrongly segmented into three, with their skeletons (Figure 2.7)."""

from reproduction.chapter2.scenes.scene_example import draw_examples

draw = draw_examples
