"""The worked example of golf: belief and clubs at a hole of 179 yards (C4.1; Table 4.2)."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter4.category_bars import CLUB_COLOURS
from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PRINTED = (1.3863, 0.2237, 0.0)
_HOLES = ("110 yd", "150 yd", "170 yd", "220 yd")
_HOLE_COLOURS = (PURPLE, GREEN, ORANGE, BLUE)
_CLUBS = ("3-wood", "3-iron", "6-iron", "9-iron")


def draw_golf_example(result: Mapping) -> "Figure":
    """From C4.1's result: belief along the printed shots, its entropy beside print, clubs of rounds played."""
    rows, settings = result["rows"], result["settings"]
    printed = next(row for row in rows if row["part"] == "printed")
    with house_style():
        figure = new_figure(10.6, 3.9)
        belief, spread, clubs = figure.subplots(1, 3, width_ratios=[1, 1.15, 1])
        _draw_belief(belief, printed)
        _draw_entropies(spread, printed, [row for row in rows if row["part"] == "learnt"])
        _draw_clubs(clubs, next(r for r in rows if r["part"] == "played" and r["first"] is None), settings)
        figure.suptitle(
            f"A hole {settings['distance']:g} yards away, unknown to the golfer; greedy selection",
            x=0.01,
            ha="left",
        )
    return figure


def _draw_belief(axes: "Axes", printed: Mapping) -> None:
    belief = np.array(printed["belief"])
    shots, below = np.arange(1, len(belief) + 1), np.zeros(len(belief))
    for k, (name, colour) in enumerate(zip(_HOLES, _HOLE_COLOURS, strict=True)):
        axes.bar(shots, belief[:, k], 0.8, bottom=below, color=colour, label=name)
        below += belief[:, k]
    axes.set(title="Belief along the printed shots", xlabel="before shot", ylim=(0, 1), xticks=shots)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=4, handlelength=1, columnspacing=1)


def _draw_entropies(axes: "Axes", printed: Mapping, learnt: list[Mapping]) -> None:
    """After one and two shots: print, exact models, and the middle 95 % of learnt ones."""
    for k in (1, 2):
        left = (k - 1) * (len(learnt) + 2.2)
        axes.plot([left - 0.6, left + len(learnt) + 0.6], [PRINTED[k]] * 2, color=INK, lw=1.1, ls=(0, (4, 2)))
        axes.plot([left], [printed["entropy"][k]], "D", color=INK, ms=6)
        for i, row in enumerate(learnt):
            low, quarter, middle, third, high = row["entropy_quantiles"][k - 1]
            colour = BLUE if row["pseudo_count"] else ORANGE
            axes.plot([left + i + 1] * 2, [low, high], color=colour, lw=1.2)
            axes.plot([left + i + 1] * 2, [quarter, third], color=colour, lw=6, solid_capstyle="butt")
            wide = third - quarter > 0.03  # else the mark would hide the bar
            axes.plot(
                [left + i + 1],
                [middle],
                "_" if wide else "o",
                color="white" if wide else colour,
                ms=8 if wide else 5,
            )
    ticks, names = [], []
    for k in (1, 2):
        left = (k - 1) * (len(learnt) + 2.2)
        ticks += [left + i for i in range(len(learnt) + 1)]
        names += ["exact", *(str(row["samples"]) for row in learnt)]
        axes.text(
            left + len(learnt) / 2, -0.24, f"after shot {k}", ha="center", va="top", fontsize=9,
            transform=axes.get_xaxis_transform(),
        )  # fmt: skip
    axes.set_xticks(ticks, names, rotation=45)
    axes.set(title="Entropy of the belief, nats", ylim=(-0.02, None))
    axes.plot([], [], color=INK, lw=1.1, ls=(0, (4, 2)), label="printed")
    pseudo = {bool(row["pseudo_count"]): row["pseudo_count"] for row in learnt}
    for some, colour in ((True, BLUE), (False, ORANGE)):
        if some in pseudo:
            axes.plot([], [], color=colour, lw=5, label=f"learnt, pseudo-count {pseudo[some]:g}")
    axes.legend(loc="upper right")


def _draw_clubs(axes: "Axes", played: Mapping, settings: Mapping) -> None:
    share = np.array(played["clubs"], float) / settings["rounds"]
    shots, below = np.arange(1, len(share) + 1), np.zeros(len(share))
    for k, name in enumerate(_CLUBS):
        axes.bar(shots, share[:, k], 0.8, bottom=below, color=CLUB_COLOURS[k], label=name)
        below += share[:, k]
    for shot, error in zip(shots, played["error"], strict=True):
        axes.text(float(shot), 1.02, f"{error:.0f}", ha="center", va="bottom", fontsize=8, color=GREY)
    axes.text(0.3, 1.02, "yd", ha="right", va="bottom", fontsize=8, color=GREY)
    axes.set(xlabel="shot", ylim=(0, 1), xticks=shots)
    axes.set_title("Clubs played, mean error above", pad=18)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=4, handlelength=1, columnspacing=1)
