"""Loss by the diversity of the population for each method, and how far BEAT is below the others in every game."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    LIGHT,
    PURPLE,
    SKY,
    VERMILION,
    house_style,
    new_figure,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LINES = {
    "EXP-3 as printed": (VERMILION, "-"),
    "EXP-3 tuned": (VERMILION, (0, (4, 2))),
    "best static speed": (INK, "-"),
    "BEAT, ε as printed": (BLUE, "-"),
    "BEAT, ε = 1/n": (PURPLE, (0, (4, 2))),
    "BEAT": (SKY, "-"),
    "BEAT, told the population": (GREEN, (0, (4, 2))),
    "best speed of each type": (GREY, (0, (1, 2))),
}
"""Colour and dash by method, in the order of the legend."""
AGAINST = {"EXP-3\nprinted": "EXP-3 as printed", "EXP-3\ntuned": "EXP-3 tuned"}


def draw_population_diversity(result: Mapping) -> "Figure":
    """The figure from the rows of C4.12's result; the first game in curves."""
    games = list(dict.fromkeys(row["words"] for row in result["rows"]))
    with house_style():
        figure = new_figure(10.4, max(3.8, 0.3 * len(games) + 1.6))
        left, right = figure.subplots(1, 2, width_ratios=[1.25, 1])
        _draw_curves(left, [row for row in result["rows"] if row["words"] == games[0]])
        _draw_ratios(right, result["rows"], games)
        left.set_title(games[0])
    return figure


def _draw_curves(axes: "Axes", rows: Sequence[Mapping]) -> None:
    diversity = [row["diversity"] for row in rows]
    for method, (colour, dash) in LINES.items():
        mean = np.array([row["loss"][method] for row in rows])
        half = np.array([row["error"][method] for row in rows])
        if method in ("EXP-3 as printed", "best static speed", "BEAT, ε as printed", "BEAT"):
            axes.fill_between(diversity, mean - half, mean + half, color=colour, alpha=0.12, linewidth=0)
        axes.plot(diversity, mean, color=colour, linestyle=dash, label=method, marker="o", markersize=3)
    low, high = axes.get_ylim()
    # The legend stands below the curves.
    axes.set(xlabel="types in the population", ylabel="mean loss of an episode", xticks=diversity)
    axes.set_ylim(low - 0.45 * (high - low), high)
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="lower left", ncols=2)


def _draw_ratios(axes: "Axes", rows: Sequence[Mapping], games: Sequence[str]) -> None:
    columns = ["EXP-3\nprinted", "EXP-3\ntuned", *(f"static\nof {x}" for x in (1, 3, 6))]
    values = np.array([_ratios([row for row in rows if row["words"] == game]) for game in games])
    draw_heat_grid(
        axes, values, np.zeros(values.shape, bool), games, columns, neutral=1.0, spread=1.35, good="low",
        ratio=True, words="{:.2f}".format,
    )  # fmt: skip
    axes.set_title("loss of BEAT (ε = 0) as a share of that of")


def _ratios(rows: Sequence[Mapping]) -> list[float]:
    weights = np.array([row["n"] for row in rows], float)

    def mean(method: str) -> float:
        return float(np.average([row["loss"][method] for row in rows], weights=weights))

    at = {row["diversity"]: row["loss"] for row in rows}
    static = [at[x]["BEAT"] / at[x]["best static speed"] for x in (1, 3, 6)]
    return [mean("BEAT") / mean(other) for other in AGAINST.values()] + static
