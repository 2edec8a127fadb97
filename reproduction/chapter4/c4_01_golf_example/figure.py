"""The worked example of golf: belief along the printed shots, its entropy, and the clubs of rounds played."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.domains.golf.golf import CLUBS, HOLES
from lifelore.figures.style import (
    BLUE,
    GREY,
    INK,
    LIGHT,
    ORANGE,
    SKY,
    VERMILION,
    YELLOW,
    Axes,
    Figure,
    house_style,
    new_figure,
)
from reproduction.chapter4.c4_01_golf_example.measure import PRINTED_ENTROPY
from reproduction.chapter4.golf.category_bars import CLUB_COLOURS
from reproduction.engine.results_table import ResultsTable

HOLE_COLOURS = (LIGHT, SKY, YELLOW, VERMILION)
"""Other colours than those of the clubs."""


def draw(result: Mapping) -> Figure:
    table, settings = ResultsTable(result["rows"], ("part", "first")), result["settings"]
    printed, played = table.record(part="printed"), table.record(part="played", first=None)
    with house_style():
        figure = new_figure(10.6, 3.9)
        belief, entropies, clubs = figure.subplots(1, 3, width_ratios=[1, 1.15, 1])
        _draw_shares(belief, printed["belief"], [f"{hole:g} yd" for hole in HOLES], HOLE_COLOURS)
        belief.set(title="Belief along the printed shots", xlabel="before shot", ylabel="probability of each hole")
        _draw_entropies(entropies, printed["entropy"], table.select(part="learnt").records)
        _draw_shares(clubs, np.array(played["clubs"]) / settings["rounds"], CLUBS, CLUB_COLOURS)
        for shot, error in enumerate(played["error"], 1):
            clubs.text(shot, 1.02, f"{error:.0f}", ha="center", va="bottom", fontsize=8, color=GREY)
        clubs.text(0.3, 1.02, "yd", ha="right", va="bottom", fontsize=8, color=GREY)
        clubs.set(xlabel="shot", ylabel="share of rounds")
        clubs.set_title("Clubs played, mean error above", pad=18)
        words = f"A hole {settings['distance']:g} yards away, unknown to the golfer; greedy selection"
        figure.suptitle(words, x=0.01, ha="left")
    return figure


def _draw_shares(axes: Axes, shares: Sequence, names: Sequence[str], colours: Sequence[str]) -> None:
    """Stacked bars, a bar for each row of `shares` (n_shots, n_names)."""
    table = np.array(shares, float)
    shots, below = np.arange(1, len(table) + 1), np.cumsum(table, axis=1) - table
    for k, (name, colour) in enumerate(zip(names, colours, strict=True)):
        axes.bar(shots, table[:, k], 0.8, bottom=below[:, k], color=colour, label=name)
    axes.set(ylim=(0, 1), xticks=shots)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=4, handlelength=1, columnspacing=1)


def _draw_entropies(axes: Axes, exact: Sequence[float], learnt: Sequence[Mapping]) -> None:
    """After one and two shots: print, exact models, and the middle half and 95 % of learnt models."""
    ticks, n = {}, len(learnt)
    sizes = list(dict.fromkeys(row["samples"] for row in learnt))
    for k in (1, 2):
        left = (k - 1) * (n + 2.2)
        axes.plot([left - 0.6, left + n + 0.6], [PRINTED_ENTROPY[k]] * 2, color=INK, lw=1.1, ls="--")
        axes.plot(left, exact[k], "D", color=INK, ms=6)
        places = {size: [at for at, row in enumerate(learnt, 1) if row["samples"] == size] for size in sizes}
        ticks |= {left: "exact"} | {left + float(np.mean(at)): f"{size}" for size, at in places.items()}
        for place, row in enumerate(learnt, 1):
            low, quarter, middle, third, high = row["entropy_quantiles"][k - 1]
            x, colour = left + place, BLUE if row["pseudo_count"] else ORANGE
            axes.plot([x, x], [low, high], color=colour, lw=1.2)
            axes.plot([x, x], [quarter, third], color=colour, lw=6, solid_capstyle="butt")
            wide = third - quarter > 0.03  # otherwise the mark would hide the bar
            axes.plot(x, middle, "_" if wide else "o", color="white" if wide else colour, ms=6)
        below = axes.get_xaxis_transform()
        axes.text(left + n / 2, -0.1, f"after shot {k}", ha="center", va="top", fontsize=9, transform=below)
    axes.set_xticks(list(ticks), list(ticks.values()))
    axes.set(title="Entropy of the belief", ylabel="nats", ylim=(-0.02, None))
    axes.set_xlabel("models: exact, or learnt from so many shots a pair", labelpad=18)
    axes.plot([], [], color=INK, lw=1.1, ls="--", label="printed")
    for pseudo in dict.fromkeys(row["pseudo_count"] for row in learnt):
        axes.plot([], [], color=BLUE if pseudo else ORANGE, lw=5, label=f"learnt, pseudo-count {pseudo:g}")
    axes.legend(loc="upper right")
