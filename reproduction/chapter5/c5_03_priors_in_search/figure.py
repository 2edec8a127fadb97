"""Figure of claim C5.3: tree search, depth-first search and bandits, with an action prior and without."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.figures.style import BLUE, GREEN, GREY, VERMILION, Axes
from reproduction.figures.curves import draw_curves
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

KINDS = {None: ("no prior", GREY), "place": ("prior on places", BLUE), "percept": ("prior on percepts", GREEN)}
INDICES = {"ucb1": "Bandits: UCB1", "beta": "Bandits: Thompson sampling"}
EVEN = ("pseudo-pulls spread evenly", VERMILION)


@panels(12.4, 3.6, 1, 4, width_ratios=(0.8, 0.8, 1, 1))
def draw(result: Mapping, *every: Axes) -> None:
    """The figure from the result."""
    searched = [row for row in result["rows"] if "reached" in row]
    words = (
        ("reached", "Tree search", "share of goals reached"),
        ("expanded", "Depth-first search", "nodes expanded"),
    )
    for axes, (key, title, label) in zip(every, words, strict=False):
        names, colours = zip(*(KINDS[row["kind"]] for row in searched), strict=True)
        names = [name.replace("prior on ", "prior on\n") for name in names]
        numbers = {key: [row[key] for row in searched]}
        draw_interval_bars(
            axes,
            names,
            numbers,
            colours=colours,
            horizontal=False,
            words="{:.2g}".format,
            title=title,
            label=label,
        )
    for axes, (index, title) in zip(every[2:], INDICES.items(), strict=True):
        _draw_regret(
            axes, result["settings"]["pulls"], [r for r in result["rows"] if r.get("index") == index], title
        )
    every[2].set_ylabel("regret so far")
    every[3].figure.legend(*every[3].get_legend_handles_labels(), loc="outside lower right", ncols=4)


def _draw_regret(axes: Axes, pulls: int, rows: Sequence[Mapping], title: str) -> None:
    looks = {(row["kind"], row["form"]): EVEN if row["form"] == "even" else KINDS[row["kind"]] for row in rows}
    series = {looks[row["kind"], row["form"]][0]: row for row in rows}
    x = np.unique(np.linspace(0, pulls - 1, len(rows[0]["mean"])).astype(int)) + 1
    colours = {name: {"color": colour} for name, colour in looks.values()}
    draw_curves(axes, x, series, looks=colours, title=title, xlabel="pulls", legend=False)
    axes.set_ylim(bottom=0)
