"""Graphical models of chapter 4: types and tasks (Figure 4.2), and the model of user interaction (§4.8.3)."""

from itertools import pairwise

import numpy as np

from lifelore.figures.style import BLUE, GREY, INK, LIGHT, ORANGE, PAPER, house_style, new_figure

_RADIUS = 0.35
_PLACES = {
    "$G_0$": (0.6, 4.4), "$\\tau$": (2.6, 4.4), "$s_t$": (0.9, 2.4), "$a_t$": (2.6, 2.4), "$s_{t+1}$": (4.6, 2.4),
    "$\\alpha_t$": (2.6, 0.6), "$\\beta^t$": (0.9, 0.6), "$\\beta^{t+1}$": (4.6, 0.6),
}  # fmt: skip
_FILL = dict.fromkeys(_PLACES, LIGHT) | {"$\\tau$": PAPER, "$\\alpha_t$": ORANGE}
_WORLD = [("$G_0$", "$\\tau$"), ("$\\tau$", "$a_t$"), ("$\\tau$", "$s_{t+1}$"), ("$s_t$", "$a_t$"),
          ("$a_t$", "$s_{t+1}$"), ("$s_t$", "$s_{t+1}$")]  # fmt: skip
_LEARNER = [("$\\beta^t$", "$\\alpha_t$"), ("$\\alpha_t$", "$a_t$"), ("$s_{t+1}$", "$\\beta^{t+1}$")]
_NOTES = {
    4.4: "the user's type, hidden",
    2.4: "her move, seen:\n$T(s_{t+1} | s_t, a_t; \\tau)$",
    0.6: "the learner: belief,\naction set, belief",
}


def draw_type_model():
    """(a) G₀ draws a type, the type a task; (b) each type's tasks stand as one landmark."""
    panels = {
        "(a) Tasks of types": (
            [
                (0.8, "$G_0$", ""), (2.8, "$\\tau$", "$\\tau \\sim G_0$"),
                (4.8, "$\\mu$", "$\\mu \\sim \\Delta^{\\tau}(\\mu)$"),
            ],
            [(2.0, 5.9, 0.35, 2.95, "types"), (3.85, 5.7, 0.75, 2.55, "tasks")],
        ),
        "(b) A landmark for each type": (
            [(1.5, "$G_0$", ""), (4.1, "$\\mu_{\\tau}$", "$\\tau \\sim G_0$")],
            [(3.1, 5.1, 0.75, 2.55, "types")],
        ),
    }  # fmt: skip
    with house_style():
        figure = new_figure(7.2, 3.4)
        for axes, (title, (nodes, plates)) in zip(figure.subplots(1, 2), panels.items(), strict=True):
            axes.set(xlim=(0.2, 6.1), ylim=(0.2, 3.1), aspect="equal", title=title)
            axes.axis("off")
            for x, label, below in nodes:
                _node(axes, (x, 1.75), label, PAPER if below else LIGHT)
                axes.text(x, 1.33, below, ha="center", va="top", fontsize=9, zorder=4)
            for (start, *_), (end, *_) in pairwise(nodes):
                _arrow(axes, (start, 1.75), (end, 1.75), INK)
            for plate in plates:
                _plate(axes, *plate)
    return figure


def draw_interaction_model():
    """The user's type decides her actions and their outcomes; the learner sees both and chooses the action set."""
    with house_style():
        figure = new_figure(6.4, 4.6)
        axes = figure.subplots()
        axes.set(xlim=(0, 7.6), ylim=(0, 5), aspect="equal")
        axes.axis("off")
        for ends, colour in ((_WORLD, INK), (_LEARNER, BLUE)):
            for start, end in ends:
                # From one state past the action to the next the arrow takes a bend.
                bend = -0.5 if (start, end) == ("$s_t$", "$s_{t+1}$") else 0.0
                _arrow(axes, _PLACES[start], _PLACES[end], colour, bend)
        for name, at in _PLACES.items():
            _node(axes, at, name, _FILL[name])
        for y, text in _NOTES.items():
            axes.text(5.3, y, text, va="center", fontsize=9)
    return figure


def _node(axes, at: tuple[float, float], label: str, fill: str) -> None:
    """A circle; a square where the learner decides (`ORANGE`)."""
    from matplotlib.patches import Circle, Rectangle

    look, (x, y) = {"fc": fill, "ec": INK, "lw": 1.4, "zorder": 3}, at
    square = Rectangle((x - _RADIUS, y - _RADIUS), 2 * _RADIUS, 2 * _RADIUS, **look)
    axes.add_patch(square if fill == ORANGE else Circle(at, _RADIUS, **look))
    axes.text(x, y, label, ha="center", va="center", fontsize=12.5, zorder=4)


def _arrow(axes, start: tuple[float, float], end: tuple[float, float], colour: str, bend: float = 0.0) -> None:
    first, last = np.array(start), np.array(end)
    reach = _RADIUS * (last - first) / np.linalg.norm(last - first)
    look = {"arrowstyle": "-|>", "color": colour, "lw": 1.3, "shrinkA": 0, "shrinkB": 0}
    look["connectionstyle"] = f"arc3,rad={bend}"
    axes.annotate("", tuple(last - reach), tuple(first + reach), arrowprops=look, zorder=5)


def _plate(axes, left: float, right: float, bottom: float, top: float, label: str) -> None:
    from matplotlib.patches import FancyBboxPatch

    look = {"boxstyle": "round,pad=0,rounding_size=0.1", "fc": "none", "ec": GREY, "lw": 1}
    axes.add_patch(FancyBboxPatch((left, bottom), right - left, top - bottom, **look))
    axes.text(right - 0.08, top - 0.07, label, ha="right", va="top", fontsize=9, color=GREY)
