"""Figure of claim C3.3: the thesis's Figure 3.5, returns of ε-QPAP, ε-QSAP and Q-learning in noise mazes."""

from functools import partial

from reproduction.chapter3.figures.return_curves import draw_return_curves

METHODS = {
    "q_learning": ("Q-learning", "q-learning"),
    "qsap": ("ε-QSAP, from the lattice", "eps-QSAP"),
    "qpap": ("ε-QPAP, from noise mazes", "eps-QPAP"),
}

draw = partial(draw_return_curves, methods=METHODS)
