"""How fast BEAT names the right type, step by step, and the types that it confuses half-way (Figure 4.17)."""

from collections.abc import Mapping

import numpy as np

from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import GREY, LIGHT, Axes, Figure, house_style, new_figure
from reproduction.chapter4.reuse.looks import size_lines


def draw(result: Mapping) -> Figure:
    row = result["rows"][0]
    with house_style():
        figure = new_figure(11.4, 4.1)
        right, ratio, matrix = figure.subplots(1, 3, width_ratios=[1.1, 1.1, 1])
        _draw_steps(right, row, "right", "the right type", "share named right", 0.85)
        right.set_ylim(0, 1.02)
        _draw_steps(ratio, row, "ratio", "how far off", "size named / true size (mean)", 1.0)
        ratio.set_yscale("log")
        ratio.set_yticks([0.25, 0.5, 1, 2, 4, 8], ["¼", "½", "1", "2", "4", "8"])
        ratio.minorticks_off()
        ratio.set_ylim(0.25, 8)
        figure.legend(*ratio.get_legend_handles_labels(), title="true size", ncols=6, loc="outside upper left")
        words = "Vertical line: half-way through the median first episode. Dotted: 85 %, and the true size."
        figure.supxlabel(words, fontsize=8, color=GREY)
        counts, names = np.array(row["half"]), [str(b) for b in SIZES]
        percent = 100 * counts / counts.sum(axis=1, keepdims=True)
        percent = np.where(percent < 0.5, np.nan, percent)
        certain = np.zeros(counts.shape, bool)
        draw_heat_grid(matrix, percent, certain, names, names, neutral=0, spread=100, words="{:.0f}".format)
        matrix.set(xlabel="size named (%)", ylabel="true size", title="half-way through the first episode")
    return figure


def _draw_steps(axes: Axes, row: Mapping, key: str, title: str, ylabel: str, level: float) -> None:
    looks = size_lines(SIZES)
    series = {name: {"mean": values} for name, values in zip(looks, row[key], strict=True)}
    draw_curves(axes, None, series, looks=looks, title=title, ylabel=ylabel, logarithmic="x", legend=False)
    axes.axhline(level, color=GREY, linestyle=(0, (1, 2)), linewidth=1)
    axes.axvline(row["median_length"] / 2, color=GREY, linewidth=1)
    axes.set(xlabel="step of the first episode", xlim=(1, len(row[key][0])))
    axes.set_xticks([1, 3, 10, 30, 100], ["1", "3", "10", "30", "100"])
    axes.minorticks_off()
    axes.grid(axis="y", color=LIGHT)
