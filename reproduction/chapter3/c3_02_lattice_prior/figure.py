"""Figure of claim C3.2: the thesis's Figure 3.3, returns of ε-QSAP and Q-learning on the lattice."""

from functools import partial

from reproduction.chapter3.figures.return_curves import draw_return_curves

METHODS = {"q_learning": ("Q-learning", "q-learning"), "eps_qsap": ("ε-QSAP", "eps-QSAP")}
draw = partial(draw_return_curves, methods=METHODS)
