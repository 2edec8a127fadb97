"""Loss by speed for each ball size, and the best speed by size in all games (Figure 4.15)."""

from collections.abc import Mapping

import numpy as np

from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS
from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import GREY, INK, LIGHT, PAPER, Axes, Figure, house_style, new_figure
from reproduction.chapter4.reuse.looks import GAMES_IN_WORDS, size_lines


def draw(result: Mapping) -> Figure:
    rows = result["rows"]
    with house_style():
        figure = new_figure(9.6, 0.25 * len(rows) + 2.2)
        left, right = figure.subplots(1, 2, width_ratios=[1.15, 1])
        _draw_losses(left, rows[0])
        names = [f"{row['words']} {'●' if row['transition'] else '○'}" for row in rows]
        best = np.array([row["best"] for row in rows])
        sizes = [f"b = {b}" for b in SIZES]
        certain = np.zeros(best.shape, bool)
        draw_heat_grid(right, best, certain, names, sizes, neutral=50, spread=35, words="{:.0f}".format)
        right.set_title("best speed (● a transition for certain)", loc="right")
        figure.supxlabel(GAMES_IN_WORDS, fontsize=8, color=GREY)
    return figure


def _draw_losses(axes: Axes, row: Mapping) -> None:
    looks = size_lines(SIZES, marker="o", markersize=3.5)
    loss, error = np.array(row["loss"]), np.array(row["error"])
    series = {name: {"mean": mean, "error": half} for name, mean, half in zip(looks, loss, error, strict=True)}
    draw_curves(axes, SPEEDS, series, looks=looks, logarithmic="y", legend=False)
    axes.set(title=row["words"], xlabel="speed (units a step)", ylabel="mean loss, band 95 %")
    for (name, look), mean in zip(looks.items(), loss, strict=True):
        best = int(mean.argmin())
        axes.plot(SPEEDS[best], mean[best], "o", color=PAPER, mec=look["color"], markersize=8, mew=1.8, zorder=4)
        axes.annotate(name, (SPEEDS[-1] + 1.2, mean[-1]), va="center", fontsize=8, color=look["color"])
    ticks = [t for t in (0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2) if loss.min() * 0.8 <= t <= loss.max() * 1.25]
    axes.set_yticks(ticks, [f"{t:g}" for t in ticks])
    axes.set(xticks=SPEEDS, xlim=(SPEEDS[0] - 2, SPEEDS[-1] + 7))
    axes.minorticks_off()
    axes.grid(axis="y", color=LIGHT)
    axes.text(0.01, 0.02, "circles: the best speed of a size", transform=axes.transAxes, fontsize=7.5, color=INK)
