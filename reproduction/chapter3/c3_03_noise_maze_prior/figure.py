"""Figure of claim C3.3: the thesis's Figure 3.5, returns of ε-QPAP, ε-QSAP and Q-learning in noise mazes."""

from collections.abc import Mapping

from lifelore.figures.style import Figure
from reproduction.chapter3.figures.return_curves import draw_return_curves

METHODS = {
    "q_learning": ("Q-learning", "q-learning"),
    "qsap": ("ε-QSAP, from the lattice", "eps-QSAP"),
    "qpap": ("ε-QPAP, from noise mazes", "eps-QPAP"),
}


def draw(result: Mapping) -> Figure:
    """The figure from the result: one run's tasks, with one standard deviation."""
    return draw_return_curves(result, METHODS)
