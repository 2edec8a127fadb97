"""Figure of claim C3.11: rewards with three forms of one prior."""

from functools import partial

from lifelore.figures.style import BLUE, GREEN, VERMILION
from reproduction.chapter3.factory.figure import one_panel

LOOKS = {
    "softmax": ("softmax", VERMILION),
    "proportion": ("proportions", BLUE),
    "dirichlet": ("Dirichlet", GREEN),
}

draw = partial(one_panel, looks=LOOKS)
