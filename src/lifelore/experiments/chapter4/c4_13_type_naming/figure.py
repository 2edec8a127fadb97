"""How fast BEAT names the right type, step by step, and what it confuses half-way: Figure 4.17."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.experiments.chapter4.speed_losses import size_colours
from lifelore.figures.style import GREY, INK, LIGHT, PAPER, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_type_naming(result, SIZES)


def draw_type_naming(result: Mapping, sizes: Sequence[int]) -> "Figure":
    """The figure from the rows of C4.13's result: shares right, ratios of sizes, and one confusion matrix."""
    row = result["rows"][0]
    with house_style():
        figure = new_figure(11.4, 3.7)
        right, ratio, matrix = figure.subplots(1, 3, width_ratios=[1.1, 1.1, 1])
        _draw_curves(right, row, "right", sizes)
        right.set(ylabel="share named right", ylim=(0, 1.02), title="the right type")
        right.axhline(0.85, color=GREY, linestyle=(0, (1, 2)), linewidth=1)
        _draw_curves(ratio, row, "ratio", sizes)
        ratio.axhline(1, color=INK, linestyle=(0, (1, 2)), linewidth=1)
        ratio.set(ylabel="size named / true size (mean)", yscale="log", title="how far off")
        ratio.set_yticks([0.25, 0.5, 1, 2, 4, 8], ["¼", "½", "1", "2", "4", "8"])
        ratio.minorticks_off()
        ratio.legend(title="true size", ncols=2, loc="upper right")
        _draw_matrix(matrix, np.array(row["half"]), sizes)
    return figure


def _draw_curves(axes: "Axes", row: Mapping, key: str, sizes: Sequence[int]) -> None:
    for b, values, colour in zip(sizes, row[key], size_colours(len(sizes)), strict=True):
        axes.plot(np.arange(1, len(values) + 1), values, color=colour, label=f"b = {b}")
    axes.axvline(row["median_length"] / 2, color=GREY, linewidth=1)
    axes.set(xscale="log", xlabel="step of the first episode", xlim=(1, len(row[key][0])))
    axes.set_xticks([1, 3, 10, 30, 100], ["1", "3", "10", "30", "100"])
    axes.minorticks_off()
    axes.grid(axis="y", color=LIGHT)


def _draw_matrix(axes: "Axes", counts: np.ndarray, sizes: Sequence[int]) -> None:
    shares = counts / counts.sum(axis=1, keepdims=True)
    axes.imshow(shares, cmap="Blues", vmin=0, vmax=1)
    for (i, j), value in np.ndenumerate(shares):
        if value >= 0.005:
            colour = PAPER if value > 0.55 else INK
            axes.text(j, i, f"{100 * value:.0f}", ha="center", va="center", fontsize=8, color=colour)
    names = [str(b) for b in sizes]
    axes.set_xticks(range(len(sizes)), names)
    axes.set_yticks(range(len(sizes)), names)
    axes.set(xlabel="size named (%)", ylabel="true size", title="half-way through the first episode")
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
