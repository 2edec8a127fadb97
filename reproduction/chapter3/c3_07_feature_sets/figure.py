"""Figure of claim C3.7: rewards with priors over four sets of features, over states, and without a prior."""

from functools import partial

from lifelore.figures.style import GREY, VERMILION, colour_of
from reproduction.chapter3.factory.figure import one_panel

LOOKS = {
    "uniform": ("uniform prior", GREY),
    "state": ("state prior", VERMILION),
    "phi1": ("φ1: own cell, Items", colour_of("phi1")),
    "phi2": ("φ2: N, S, E, W", colour_of("phi2")),
    "phi3": ("φ3: φ1 and φ2", colour_of("phi3")),
    "phi4": ("φ4: 3×3 cells, Items", colour_of("phi4")),
}

draw = partial(one_panel, looks=LOOKS, plain=("state", "phi1", "phi2", "phi4"))
