"""Figure of claim C3.12: learning with priors demonstrated by simulated people, and with self-trained priors."""

from functools import partial

from lifelore.figures.style import BLUE, GREEN, GREY
from reproduction.chapter3.factory.figure import one_panel

LOOKS = {
    "uniform": ("uniform prior", GREY),
    "shown": ("prior from demonstrations (simulated person)", GREEN),
    "self-trained": ("self-trained prior", BLUE),
}

draw = partial(one_panel, looks=LOOKS)
