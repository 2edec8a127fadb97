"""Loss by speed for each ball size, and the best speed by size over all games: Figure 4.15 and its grid."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.style import INK, LIGHT, PAPER, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def size_colours(n: int) -> list:
    """Colours from small balls to large ones."""
    from matplotlib import colormaps

    return [colormaps["viridis"](x) for x in np.linspace(0.0, 0.9, n)]


def draw_speed_losses(result: Mapping, sizes: Sequence[int], speeds: Sequence[int]) -> "Figure":
    """The figure from the rows of C4.11's result, the first row's game in curves."""
    with house_style():
        figure = new_figure(9.6, 0.25 * len(result["rows"]) + 1.8)
        left, right = figure.subplots(1, 2, width_ratios=[1.15, 1])
        _draw_curves(left, result["rows"][0], sizes, speeds)
        _draw_grid(right, result["rows"], sizes, speeds)
    return figure


def _draw_curves(axes: "Axes", row: Mapping, sizes: Sequence[int], speeds: Sequence[int]) -> None:
    loss, error = np.array(row["loss"]), np.array(row["error"])
    for mean, half, colour in zip(loss, error, size_colours(len(sizes)), strict=True):
        axes.errorbar(speeds, mean, half, color=colour, marker="o", markersize=3.5, capsize=2)
        best = int(mean.argmin())
        axes.plot(
            speeds[best], mean[best], "o", color=PAPER, markeredgecolor=colour, markersize=8, mew=1.8, zorder=4
        )
    for b, y, colour in zip(sizes, _apart(loss[:, -1]), size_colours(len(sizes)), strict=True):
        axes.annotate(f"b = {b}", (speeds[-1] + 1.2, y), va="center", fontsize=8, color=colour)
    axes.set(
        xlabel="speed (units a step)", ylabel="mean loss", xticks=list(speeds), yscale="log", title=row["words"]
    )
    ticks = [t for t in (0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2) if loss.min() * 0.8 <= t <= loss.max() * 1.25]
    axes.set_yticks(ticks, [f"{t:g}" for t in ticks])
    axes.minorticks_off()
    axes.set_xlim(speeds[0] - 2, speeds[-1] + 7)
    axes.grid(axis="y", color=LIGHT)
    axes.text(0.01, 0.02, "circles: the best speed of a size", transform=axes.transAxes, fontsize=7.5, color=INK)


def _apart(values: np.ndarray, factor: float = 1.07) -> np.ndarray:
    """Heights of labels on a logarithmic axis: each at its value, or as little above as keeps them apart."""
    placed = np.array(values, float)
    for lower, upper in pairwise(np.argsort(values)):
        placed[upper] = max(placed[upper], placed[lower] * factor)
    return placed


def _draw_grid(axes: "Axes", rows: Sequence[Mapping], sizes: Sequence[int], speeds: Sequence[int]) -> None:
    from matplotlib import colormaps

    best = np.array([row["best"] for row in rows])
    colours = colormaps["RdBu"].resampled(256)
    axes.imshow(best, cmap=colours, vmin=speeds[0] - 15, vmax=speeds[-1] + 15, aspect="auto", alpha=0.75)
    for (i, j), speed in np.ndenumerate(best):
        axes.text(j, i, str(speed), ha="center", va="center", fontsize=7.5, color=INK)
    axes.set_xticks(range(len(sizes)), [f"b = {b}" for b in sizes])
    names = [f"{row['words']} {'●' if row['transition'] else '○'}" for row in rows]
    axes.set_yticks(range(len(rows)), names)
    axes.set_xticks(np.arange(len(sizes) + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(len(rows) + 1) - 0.5, minor=True)
    axes.grid(which="minor", color=PAPER, linewidth=1.5)
    axes.tick_params(which="both", length=0)
    axes.set_title("best speed (● a transition for certain)", loc="right")
    for spine in axes.spines.values():
        spine.set_visible(False)
