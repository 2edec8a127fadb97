"""Figure of claim C3.2: the thesis's Figure 3.3, returns of ε-QSAP and Q-learning on the lattice."""

from collections.abc import Mapping

from lifelore.figures.style import Figure
from reproduction.chapter3.figures.return_curves import draw_return_curves


def draw(result: Mapping) -> Figure:
    """The figure from the result: one run's tasks, with one standard deviation."""
    return draw_return_curves(
        result, {"q_learning": ("Q-learning", "q-learning"), "eps_qsap": ("ε-QSAP", "eps-QSAP")}
    )
