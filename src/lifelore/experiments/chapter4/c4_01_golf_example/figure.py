"""The worked example of golf: belief along the printed shots, its entropy, and the clubs of rounds played."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.domains.golf.golf import CLUBS, HOLES
from lifelore.experiments.chapter4.c4_01_golf_example.measure import PRINTED_ENTROPY
from lifelore.experiments.chapter4.category_bars import CLUB_COLOURS
from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HOLE_COLOURS = (PURPLE, GREEN, ORANGE, BLUE)


def draw(result: Mapping) -> "Figure":
    """Stacked shares of the belief, entropies of learnt models, and stacked shares of the clubs."""
    rows, settings = result["rows"], result["settings"]
    printed = next(row for row in rows if row["part"] == "printed")
    played = next(row for row in rows if row["part"] == "played" and row["first"] is None)
    with house_style():
        figure = new_figure(10.6, 3.9)
        belief, entropies, clubs = figure.subplots(1, 3, width_ratios=[1, 1.15, 1])
        _draw_shares(belief, printed["belief"], [f"{hole:g} yd" for hole in HOLES], HOLE_COLOURS)
        belief.set(title="Belief along the printed shots", xlabel="before shot")
        _draw_entropies(entropies, printed["entropy"], [row for row in rows if row["part"] == "learnt"])
        _draw_shares(clubs, np.array(played["clubs"]) / settings["rounds"], CLUBS, CLUB_COLOURS)
        for shot, error in enumerate(played["error"], 1):
            clubs.text(shot, 1.02, f"{error:.0f}", ha="center", va="bottom", fontsize=8, color=GREY)
        clubs.text(0.3, 1.02, "yd", ha="right", va="bottom", fontsize=8, color=GREY)
        clubs.set_xlabel("shot")
        clubs.set_title("Clubs played, mean error above", pad=18)
        words = f"A hole {settings['distance']:g} yards away, unknown to the golfer; greedy selection"
        figure.suptitle(words, x=0.01, ha="left")
    return figure


def _draw_shares(axes: "Axes", shares: Sequence, names: Sequence[str], colours: Sequence[str]) -> None:
    """Stacked bars, a bar for each row of `shares` (n_shots, n_names)."""
    table = np.array(shares, float)
    shots, below = np.arange(1, len(table) + 1), np.cumsum(table, axis=1) - table
    for k, (name, colour) in enumerate(zip(names, colours, strict=True)):
        axes.bar(shots, table[:, k], 0.8, bottom=below[:, k], color=colour, label=name)
    axes.set(ylim=(0, 1), xticks=shots)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=4, handlelength=1, columnspacing=1)


def _draw_entropies(axes: "Axes", exact: Sequence[float], learnt: Sequence[Mapping]) -> None:
    """After one and two shots: print, exact models, and the middle half and 95 % of learnt models."""
    ticks, names = [], []
    for k in (1, 2):
        left = (k - 1) * (len(learnt) + 2.2)
        axes.plot([left - 0.6, left + len(learnt) + 0.6], [PRINTED_ENTROPY[k]] * 2, color=INK, lw=1.1, ls="--")
        axes.plot([left], [exact[k]], "D", color=INK, ms=6)
        for place, row in enumerate(learnt, 1):
            low, quarter, middle, third, high = row["entropy_quantiles"][k - 1]
            colour = BLUE if row["pseudo_count"] else ORANGE
            axes.plot([left + place] * 2, [low, high], color=colour, lw=1.2)
            axes.plot([left + place] * 2, [quarter, third], color=colour, lw=6, solid_capstyle="butt")
            wide = third - quarter > 0.03  # otherwise the mark would hide the bar
            axes.plot([left + place], [middle], "_" if wide else "o", color="white" if wide else colour, ms=6)
        ticks += [left + place for place in range(len(learnt) + 1)]
        names += ["exact", *(str(row["samples"]) for row in learnt)]
        axes.text(
            left + len(learnt) / 2, -0.24, f"after shot {k}", ha="center", va="top", fontsize=9,
            transform=axes.get_xaxis_transform(),
        )  # fmt: skip
    axes.set_xticks(ticks, names, rotation=45)
    axes.set(title="Entropy of the belief, nats", ylim=(-0.02, None))
    axes.plot([], [], color=INK, lw=1.1, ls="--", label="printed")
    for pseudo in dict.fromkeys(row["pseudo_count"] for row in learnt):
        axes.plot([], [], color=BLUE if pseudo else ORANGE, lw=5, label=f"learnt, pseudo-count {pseudo:g}")
    axes.legend(loc="upper right")
