"""The transition system of a telephone call (the thesis's Figure 4.5)."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from lifelore.figures.style import BLUE, GREY, INK, PAPER, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PLACES = {
    "start": (0.0, 0.0),
    "frustrated": (2.6, 0.0),
    "annoyed": (5.2, 0.0),
    "angry": (7.8, 0.0),
    "success": (3.9, 2.1),
    "hung up": (3.9, -2.1),
}
_ENDS = ("angry", "success", "hung up")
_RADIUS = 0.62


def draw_call_graph(edges: Mapping[tuple[str, str], tuple[str, float]], title: str = "") -> "Figure":
    """States as circles, those that end the call with a thick rim.

    Parameters
    ----------
    edges : mapping
        (state, next state) to what its probability is called and its reward; states are keys of `PLACES`.
    title : str
    """
    with house_style():
        figure = new_figure(7.4, 4.2)
        axes = figure.subplots()
        fill_call_graph(axes, edges)
        axes.set_title(title)
    return figure


def fill_call_graph(axes: "Axes", edges: Mapping[tuple[str, str], tuple[str, float]], fontsize: float = 9) -> None:
    """Draw into `axes`; see `draw_call_graph`."""
    from matplotlib.patches import Circle

    for (start, end), (probability, reward) in edges.items():
        _draw_edge(axes, start, end, probability, f"[{reward:g}]", fontsize)
    for name, (x, y) in PLACES.items():
        thick = name in _ENDS
        axes.add_patch(Circle((x, y), _RADIUS, fc=PAPER, ec=INK, lw=3 if thick else 1.2, zorder=3))
        axes.text(x, y, name, ha="center", va="center", fontsize=fontsize - 1, zorder=4)
    axes.set(xlim=(-0.9, 8.7), ylim=(-2.95, 2.95), aspect="equal")
    axes.axis("off")


def _draw_edge(axes: "Axes", start: str, end: str, probability: str, reward: str, fontsize: float) -> None:
    (x0, y0), (x1, y1) = PLACES[start], PLACES[end]
    length = ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5
    dx, dy = (x1 - x0) / length, (y1 - y0) / length
    tail = (x0 + dx * _RADIUS, y0 + dy * _RADIUS)
    head = (x1 - dx * (_RADIUS + 0.04), y1 - dy * (_RADIUS + 0.04))
    arrow = {"arrowstyle": "-|>", "color": GREY, "lw": 1.1, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", head, tail, arrowprops=arrow, zorder=2)
    # Nearer the start, where edges to one state have not yet met.
    share = 0.5 if dy == 0 else 0.52 if start == "frustrated" else 0.34
    x, y = tail[0] + share * (head[0] - tail[0]), tail[1] + share * (head[1] - tail[1])
    box = {"boxstyle": "round,pad=0.12", "fc": PAPER, "ec": "none"}
    above = 0.28 if dy == 0 else 0.17
    axes.text(
        x, y + above, probability, color=BLUE, ha="center", va="center", fontsize=fontsize, bbox=box, zorder=2.5
    )
    axes.text(
        x, y - above, reward, color=INK, ha="center", va="center", fontsize=fontsize - 2, bbox=box, zorder=2.5
    )
