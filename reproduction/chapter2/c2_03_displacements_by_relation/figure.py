"""Displacements between contact points, seen from the front and coloured by relation (Figure 2.4)."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.relations import ADJACENT
from lifelore.figures.scenes.object_palette import mixed
from lifelore.figures.style import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PAPER, Axes
from reproduction.chapter2.c2_03_displacements_by_relation.run import EDGE
from reproduction.figures.panels import panels

LOOKS = {"on": (BLUE, "o"), "adjacent": (ORANGE, "s"), "both": (GREEN, "^"), "none": (GREY, "x")}
"""Colour and marker of each relation, distinguishable with every common colour blindness."""
CLOSE = 20
"""Millimetres; how far the second view reaches."""


@panels(9.6, 4.6, 1, 2, grid="")
def draw(result: Mapping, whole: Axes, close: Axes) -> None:
    """All displacements, and those close to the origin."""
    rows = result["rows"]
    furthest = 1.05 * max(np.abs(row["mm"]).max() for row in rows)
    draw_displacements(whole, rows, "all displacements", furthest)
    draw_displacements(close, rows, f"within {CLOSE} mm", CLOSE)
    whole.legend(loc="upper right")
    right, down = (place + 0.0 for place in rows[0]["middle_of_on"])
    close.plot(right, down, "+", ms=13, mew=2, color=INK, zorder=5)
    words = f"+ middle of on ({right:.1f}, {down:.1f}) mm\nthesis: (0, −0.5), no unit".replace("-", "−")
    box = {"facecolor": PAPER, "edgecolor": "none", "alpha": 0.8, "pad": 2}
    close.annotate(words, (0.03, 0.03), xycoords="axes fraction", fontsize=8, color=INK, bbox=box, zorder=6)
    close.annotate("band of adjacent (thesis: above y = −0.1)", (0.04, 0.95), xycoords="axes fraction", fontsize=8)


def draw_displacements(axes: Axes, rows: Sequence[Mapping], title: str, reach: float) -> None:
    """The displacements of each relation within `reach` mm, and the band of *adjacent*, shaded.

    Many points fade, so that dense places stay visible.
    `rows` are ``{"relation", "mm", "middle_of_on"}``.
    """
    down = rows[0]["middle_of_on"][1]
    groups = {row["relation"]: np.array(row["mm"]).reshape(-1, 2) for row in rows}
    axes.axhline(0, color=LIGHT, lw=1, zorder=0)
    axes.axvline(0, color=LIGHT, lw=1, zorder=0)
    for relation, at in groups.items():
        colour, marker = LOOKS[relation]
        alpha = float(np.clip(12 / np.sqrt(max(1, len(at))), 0.25, 0.85))
        edge = {} if marker == "x" else {"edgecolors": mixed(colour, INK, 0.3)}
        axes.scatter(*at.T, s=20, marker=marker, color=colour, alpha=alpha, linewidths=0.5, **edge)
        axes.scatter([], [], s=22, marker=marker, color=colour, label=relation)
    axes.set(title=title, xlabel="x (mm to the right)", ylabel="y (mm, down is positive, as in a picture)")
    if down is not None:
        ends = sorted((EDGE * down, -np.sign(down) * 2 * reach))
        axes.axhspan(ends[0], ends[1], color=mixed(LOOKS[ADJACENT][0], PAPER, 0.85), lw=0, zorder=-1)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set_aspect("equal")
