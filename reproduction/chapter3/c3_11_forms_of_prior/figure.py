"""Figure of claim C3.11: rewards with three forms of one prior."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREEN, VERMILION, Figure
from reproduction.chapter3.factory.figure import one_panel

LOOKS = {
    "softmax": ("softmax", VERMILION),
    "proportion": ("proportions", BLUE),
    "dirichlet": ("Dirichlet", GREEN),
}


def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    return one_panel(result, LOOKS)
