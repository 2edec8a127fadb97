"""Figure of claim C3.11: rewards with three forms of one prior."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREEN, VERMILION, Figure
from reproduction.chapter3.c3_11_forms_of_prior.run import FORMS
from reproduction.chapter3.factory.figure import looks_of, one_panel

LOOKS = looks_of(
    FORMS,
    {
        "softmax": ("softmax", VERMILION),
        "proportion": ("proportions", BLUE),
        "dirichlet": ("Dirichlet", GREEN),
    },
)


def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    return one_panel(result, LOOKS)
