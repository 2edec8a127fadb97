"""Figure of claim C4.5."""

from collections.abc import Mapping


def draw(result: Mapping):
    from lifelore.experiments.chapter4.selection_curves import draw_selection_curves

    return draw_selection_curves(result)
