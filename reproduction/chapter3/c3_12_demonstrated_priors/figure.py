"""Figure of claim C3.12: learning with priors demonstrated by simulated people, and with self-trained priors."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREEN, GREY, Figure
from reproduction.chapter3.factory.figure import one_panel

LOOKS = {
    "uniform": ("uniform prior", GREY),
    "shown": ("prior from demonstrations (simulated person)", GREEN),
    "self-trained": ("self-trained prior", BLUE),
}


def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    return one_panel(result, LOOKS)
