"""Loss by episode, loss by type against the best static speed, and how soon the type is named for good."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.experiments.chapter4.diversity_runs import EPISODES
from lifelore.experiments.chapter4.population_diversity import LINES
from lifelore.experiments.chapter4.speed_losses import size_colours
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import GREY, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_adaptation_safety(result, SIZES, EPISODES)


SHOWN = (
    "EXP-3 as printed",
    "EXP-3 tuned",
    "best static speed",
    "BEAT, ε as printed",
    "BEAT",
    "best speed of each type",
)


def draw_adaptation_safety(result: Mapping, sizes: Sequence[int], episodes: int) -> "Figure":
    """The figure from the rows of C4.15's result."""
    losses = {row["method"]: np.array(row["loss"]) for row in result["rows"] if "method" in row}
    with house_style():
        figure = new_figure(11.6, 3.9)
        by_episode, by_type, naming = figure.subplots(1, 3, width_ratios=[1, 1, 1])
        _draw_episodes(by_episode, losses, episodes)
        _draw_types(by_type, losses, sizes, episodes)
        _draw_naming(naming, result["rows"][-1], sizes)
    return figure


def _draw_episodes(axes: "Axes", losses: Mapping[str, np.ndarray], episodes: int) -> None:
    every = np.arange(1, episodes + 1)
    for method in SHOWN:
        colour, dash = LINES[method]
        axes.plot(every, losses[method].mean(axis=0), color=colour, linestyle=dash, label=method, marker="o", ms=3)
    low, high = axes.get_ylim()
    # The legend stands below the curves.
    axes.set_ylim(low - 0.75 * (high - low), high)
    axes.set(xlabel="episode", ylabel="mean loss, six types", xticks=every, title="efficiency")
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="lower left")


def _draw_types(axes: "Axes", losses: Mapping[str, np.ndarray], sizes: Sequence[int], episodes: int) -> None:
    ratios = losses["BEAT"] / losses["best static speed"]
    draw_heat_grid(
        axes, ratios, np.zeros(ratios.shape, bool), [f"b = {b}" for b in sizes],
        [str(e) for e in range(1, episodes + 1)], neutral=1.0, spread=1.35, good="low", ratio=True,
        words="{:.2f}".format,
    )  # fmt: skip
    axes.set(xlabel="episode", title="safety: BEAT to the static speed")


def _draw_naming(axes: "Axes", row: Mapping, sizes: Sequence[int]) -> None:
    for b, shares, colour in zip(sizes, row["named"], size_colours(len(sizes)), strict=True):
        axes.plot(row["steps"], shares, color=colour, label=f"b = {b}")
    axes.axvline(row["length"], color=GREY, linewidth=1)
    axes.annotate(
        "end of the first episode", (row["length"], 0.02), (3, 0), textcoords="offset points", fontsize=7,
        color=GREY, rotation=90, va="bottom",
    )  # fmt: skip
    axes.set(xscale="log", xlabel="steps played", ylabel="share named right for good", ylim=(0, 1.03))
    axes.set_xticks([1, 10, 100, 500], ["1", "10", "100", "500"])
    axes.minorticks_off()
    axes.grid(axis="y", color=LIGHT)
    axes.legend(loc="upper left")
    axes.set_title("speed")
