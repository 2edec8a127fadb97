"""An L-block and a ball with their networks, with every contact and with strong ones (Figure 2.1)."""

from reproduction.chapter2.scenes.scene_example import draw_examples

draw = draw_examples
