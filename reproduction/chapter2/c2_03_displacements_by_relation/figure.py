"""Displacements between contact points, seen from the front and coloured by relation (thesis Fig 2.4)."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.relations import ADJACENT, ON
from lifelore.figures.scatter import draw_scatter
from lifelore.figures.scenes.object_palette import RELATION_MARKERS, mixed, relation_palette
from lifelore.figures.style import GREY, INK, PAPER, house_style, new_figure
from reproduction.chapter2.c2_03_displacements_by_relation.measure import EDGE

CLOSE = 25
"""Millimetres; how far the figure's second view reaches."""


def draw(result: Mapping):
    found: dict[str, list[Mapping]] = {}
    for row in result["rows"]:
        if "mm" in row:
            found.setdefault(row["scenes"], []).append(row)
    with house_style():
        figure = new_figure(10.0, 1.3 + 3.9 * len(found))
        panels = figure.subplots(len(found), 2, squeeze=False)
        for (whole, close), (kind, rows) in zip(panels, found.items(), strict=True):
            draw_displacements(whole, rows, f"{kind} pairs")
            draw_displacements(close, rows, f"{kind} pairs, within {CLOSE} mm", reach=CLOSE)
    return figure


def draw_displacements(axes, rows: Sequence[Mapping], title: str, reach: float | None = None) -> None:
    """The displacements of each relation, the middle of *on*, and the band of *adjacent*, shaded.

    `rows` are ``{"relation", "mm", "middle_of_on"}``; `reach` is the distance from the origin that is shown, mm
    (default: all).
    """
    palette = relation_palette([])
    groups = {f"{row['relation']} ({len(row['mm'])})": row for row in rows}
    draw_scatter(
        axes,
        {label: np.array(row["mm"]).reshape(-1, 2) for label, row in groups.items()},
        colours={label: palette[row["relation"]] for label, row in groups.items()},
        markers={label: RELATION_MARKERS[row["relation"]] for label, row in groups.items()},
        size=20,
        legend=None if reach else {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)},
        title=title,
        xlabel="to the right of b (mm)",
        ylabel="above b (mm)",
    )
    if reach:
        axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set_aspect("equal", adjustable="box" if reach else "datalim")
    right, up = rows[0]["middle_of_on"]
    if right is None:
        return
    low, high = axes.get_ylim()
    beyond = 100 * (high - low)
    band = (-beyond, EDGE * up) if up > 0 else (EDGE * up, beyond)
    axes.axhspan(*band, color=mixed(palette[ADJACENT], PAPER, 0.85), lw=0, zorder=-1)
    axes.set_ylim(low, high)
    centre = right + 0.0, up + 0.0  # no minus before a zero
    axes.plot(*centre, "+", ms=17, mew=5, color=PAPER, zorder=4)
    axes.plot(*centre, "+", ms=15, mew=2.2, color=mixed(palette[ON], INK, 0.45), zorder=5)
    axes.annotate(
        f"({centre[0]:.2g}, {centre[1]:.2g})", centre, (9, -3), textcoords="offset points", fontsize=7.5, va="top",
        color=INK, zorder=5, bbox={"facecolor": PAPER, "alpha": 0.75, "edgecolor": GREY, "lw": 0.4, "pad": 1.5},
    )  # fmt: skip
