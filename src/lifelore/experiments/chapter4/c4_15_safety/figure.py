"""Loss by episode, loss by type against the best static speed, and how soon the type is named for good."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.experiments.chapter4.reuse_figures import lines_of, size_lines
from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import GREY, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SHOWN = (
    "EXP-3 as printed", "EXP-3 tuned", "best static speed", "BEAT, ε as printed", "BEAT",
    "best speed of each type",
)  # fmt: skip


def draw(result: Mapping) -> "Figure":
    """Efficiency, safety and speed, a panel each."""
    losses = {row["method"]: np.array(row["loss"]) for row in result["rows"] if "method" in row}
    with house_style():
        figure = new_figure(11.6, 3.9)
        by_episode, by_type, naming = figure.subplots(1, 3)
        _draw_episodes(by_episode, losses)
        ratios = losses["BEAT"] / losses["best static speed"]
        names, episodes = [f"b = {b}" for b in SIZES], [str(e + 1) for e in range(ratios.shape[1])]
        draw_heat_grid(
            by_type, ratios, np.zeros(ratios.shape, bool), names, episodes, neutral=1.0, spread=1.35, good="low",
            ratio=True, words="{:.2f}".format,
        )  # fmt: skip
        by_type.set(xlabel="episode", title="safety: BEAT to the static speed")
        _draw_naming(naming, result["rows"][-1])
    return figure


def _draw_episodes(axes: "Axes", losses: Mapping[str, np.ndarray]) -> None:
    series = {method: {"mean": losses[method].mean(axis=0)} for method in SHOWN}
    draw_curves(axes, None, series, looks=lines_of(SHOWN, marker="o", ms=3), legend=False)
    axes.set(title="efficiency", xlabel="episode", ylabel="mean loss, six types")
    axes.set_xticks(range(1, len(series["BEAT"]["mean"]) + 1))
    low, high = axes.get_ylim()
    axes.set_ylim(low - 0.75 * (high - low), high)  # room for the legend below the curves
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="lower left")


def _draw_naming(axes: "Axes", row: Mapping) -> None:
    looks = size_lines(SIZES)
    series = {name: {"mean": shares} for name, shares in zip(looks, row["named"], strict=True)}
    draw_curves(axes, row["steps"], series, looks=looks, logarithmic="x", legend=False)
    axes.set(title="speed", xlabel="steps played", ylabel="share named right for good")
    axes.axvline(row["length"], color=GREY, linewidth=1)
    axes.annotate(
        "end of the first episode", (row["length"], 0.02), (3, 0), textcoords="offset points", fontsize=7,
        color=GREY, rotation=90, va="bottom",
    )  # fmt: skip
    axes.set_ylim(0, 1.03)
    axes.set_xticks([1, 10, 100, 500], ["1", "10", "100", "500"])
    axes.minorticks_off()
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="upper left")
