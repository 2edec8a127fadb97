"""Tasks, types and landmarks as a graphical model (the thesis's Figure 4.2)."""

from typing import TYPE_CHECKING

from lifelore.figures.style import GREY, INK, LIGHT, PAPER, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_RADIUS = 0.34


def draw_type_model() -> "Figure":
    """(a) G₀ draws a type, the type a task; (b) each type's tasks stand as one landmark."""
    with house_style():
        figure = new_figure(7.2, 3.4)
        left, right = figure.subplots(1, 2)
        _panel(left, "(a) Tasks of types")
        _node(left, 0.8, "$G_0$", observed=True)
        _node(left, 2.8, "$\\tau$", below="$\\tau \\sim G_0$")
        _node(left, 4.8, "$\\mu$", below="$\\mu \\sim \\Delta^{\\tau}(\\mu)$")
        _arrow(left, 0.8, 2.8)
        _arrow(left, 2.8, 4.8)
        _plate(left, 2.0, 5.9, 0.35, 2.95, "types")
        _plate(left, 3.85, 5.7, 0.75, 2.55, "tasks")
        _panel(right, "(b) A landmark for each type")
        _node(right, 1.5, "$G_0$", observed=True)
        _node(right, 4.1, "$\\mu_{\\tau}$", below="$\\tau \\sim G_0$")
        _arrow(right, 1.5, 4.1)
        _plate(right, 3.1, 5.1, 0.75, 2.55, "types")
    return figure


def _panel(axes: "Axes", title: str) -> None:
    axes.set(xlim=(0.2, 6.1), ylim=(0.2, 3.1), aspect="equal", title=title)
    axes.axis("off")


def _node(axes: "Axes", x: float, label: str, observed: bool = False, below: str = "") -> None:
    from matplotlib.patches import Circle

    axes.add_patch(Circle((x, 1.75), _RADIUS, fc=LIGHT if observed else PAPER, ec=INK, lw=1.4, zorder=3))
    axes.text(x, 1.75, label, ha="center", va="center", fontsize=13, zorder=4)
    axes.text(x, 1.33, below, ha="center", va="top", fontsize=9, zorder=4)


def _arrow(axes: "Axes", start: float, end: float) -> None:
    axes.annotate(
        "", (end - _RADIUS, 1.75), (start + _RADIUS, 1.75),
        arrowprops={"arrowstyle": "-|>", "color": INK, "lw": 1.3, "shrinkA": 0, "shrinkB": 0}, zorder=5,
    )  # fmt: skip


def _plate(axes: "Axes", left: float, right: float, bottom: float, top: float, label: str) -> None:
    from matplotlib.patches import FancyBboxPatch

    axes.add_patch(
        FancyBboxPatch(
            (left, bottom), right - left, top - bottom, boxstyle="round,pad=0,rounding_size=0.1", fc="none",
            ec=GREY, lw=1,
        )
    )  # fmt: skip
    axes.text(right - 0.08, top - 0.07, label, ha="right", va="top", fontsize=9, color=GREY)
