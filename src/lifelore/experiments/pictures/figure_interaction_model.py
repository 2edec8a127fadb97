"""The model of user interaction (§4.8.3) as a graph: who draws, who sees and who chooses what."""

from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.style import BLUE, INK, LIGHT, ORANGE, PAPER, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_RADIUS = 0.36
_PLACES = {
    "$G_0$": (0.6, 4.4), "$\\tau$": (2.6, 4.4), "$s_t$": (0.9, 2.4), "$a_t$": (2.6, 2.4), "$s_{t+1}$": (4.6, 2.4),
    "$\\alpha_t$": (2.6, 0.6), "$\\beta^t$": (0.9, 0.6), "$\\beta^{t+1}$": (4.6, 0.6),
}  # fmt: skip
_WORLD = [("$G_0$", "$\\tau$"), ("$\\tau$", "$a_t$"), ("$\\tau$", "$s_{t+1}$"), ("$s_t$", "$a_t$"),
          ("$a_t$", "$s_{t+1}$"), ("$s_t$", "$s_{t+1}$")]  # fmt: skip
_LEARNER = [("$\\beta^t$", "$\\alpha_t$"), ("$\\alpha_t$", "$a_t$"), ("$s_{t+1}$", "$\\beta^{t+1}$")]
_HIDDEN = ("$\\tau$",)
_CHOSEN = ("$\\alpha_t$",)


def draw_interaction_model() -> "Figure":
    """The user's type decides her actions and their outcomes; the learner sees both and chooses the action set."""
    with house_style():
        figure = new_figure(6.4, 4.6)
        axes = figure.subplots()
        axes.set(xlim=(0, 7.6), ylim=(0, 5), aspect="equal")
        axes.axis("off")
        for ends, colour in ((_WORLD, INK), (_LEARNER, BLUE)):
            for start, end in ends:
                _arrow(axes, start, end, colour)
        for name in _PLACES:
            _node(axes, name)
        notes = (
            (4.4, "the user's type, hidden"),
            (2.4, "her move, seen:\n$T(s_{t+1} | s_t, a_t; \\tau)$"),
            (0.6, "the learner: belief,\naction set, belief"),
        )
        for y, text in notes:
            axes.text(5.3, y, text, va="center", fontsize=9)
    return figure


def _node(axes: "Axes", name: str) -> None:
    from matplotlib.patches import Circle, Rectangle

    x, y = _PLACES[name]
    if name in _CHOSEN:
        side = 2 * _RADIUS
        axes.add_patch(Rectangle((x - _RADIUS, y - _RADIUS), side, side, fc=ORANGE, ec=INK, lw=1.4, zorder=3))
    else:
        axes.add_patch(Circle((x, y), _RADIUS, fc=PAPER if name in _HIDDEN else LIGHT, ec=INK, lw=1.4, zorder=3))
    axes.text(x, y, name, ha="center", va="center", fontsize=12, zorder=4)


def _arrow(axes: "Axes", start: str, end: str, colour: str) -> None:
    first, last = np.array(_PLACES[start]), np.array(_PLACES[end])
    # From one state past the action to the next it takes a bend.
    bend = "arc3,rad=-0.5" if (start, end) == ("$s_t$", "$s_{t+1}$") else "arc3"
    reach = _RADIUS * (last - first) / np.linalg.norm(last - first)
    axes.annotate(
        "", tuple(last - reach), tuple(first + reach),
        arrowprops={
            "arrowstyle": "-|>", "color": colour, "lw": 1.3, "shrinkA": 0, "shrinkB": 0, "connectionstyle": bend,
        },
        zorder=5,
    )  # fmt: skip
