"""Figure of claim C3.9: reward lost in the first and the last episode of each task, and when it is learnt on."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.style import BLUE, GREY, PURPLE, Axes, Figure, house_style, new_figure, two_rows
from reproduction.chapter3.c3_09_online_features.run import OF_E4
from reproduction.chapter3.figures.choice_grid import draw_choice_grid
from reproduction.engine.curve_blocks import block_centres

METHODS = {"uniform": ("no prior", GREY), "full": ("all ten features", PURPLE)}
METHODS |= {"selected": ("selected features", BLUE)}
"""Label and colour by method."""
DASHES = {"first": "-", "last": (0, (4, 2))}
TABLES = {
    "first_full_minus_uniform": "First episode: all ten less no prior",
    "first_selected_minus_full": "First episode: selected less all ten",
    "last_selected_minus_uniform": "Last episode: selected less no prior",
}
"""Differences of the grid's tables with their titles."""


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    settings = result["settings"]
    figure = new_figure(12.0, 10.4)
    upper, lower = two_rows(figure, (1.0, 0.48))
    panels = upper.subplots(2, len(settings["sources"]), squeeze=False, sharey="row", height_ratios=(1.0, 0.62))
    for (above, below), source in zip(panels.T, settings["sources"], strict=True):
        _draw_source(above, result, source)
        _draw_learning_on(below, result, source)
    for axes in panels[:, 0]:
        axes.set_ylabel("reward below the optimum")
    upper.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper left", ncols=6)
    _draw_tables(lower.subplots(1, len(TABLES)), result)
    lower.supxlabel(
        f"Shaded, first episodes: one standard deviation between {settings['runs']} runs. Dashed: episode "
        f"{settings['episodes']}. Learnt on: the last {settings['long_tasks']} tasks. Promising: counted as E4 "
        "says, and judged.\nTables: % of the distance from no prior in the first episode to the optimum, over the "
        "tasks after the first. Bold: the 95 % interval excludes 0. Framed: promising, at the default.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_source(axes: Axes, result: Mapping, source: str) -> None:
    series, looks = {}, {}
    optimal = result["measured"]["optimal_reward"]["value"]
    for row in result["rows"]:
        if row.get("of_source") == source:
            words, colour = METHODS[row["curve_of"]]
            label = f"{words}, {row['part']} episode"
            loss, half = optimal - np.array(row["mean"]), np.array(row["deviation"])
            series[label] = {"mean": loss}
            if row["part"] == "first":  # those of last episodes overlap, and would hide the lines
                # A logarithmic axis has no room for a band that reaches the optimum.
                series[label] |= {"low": np.maximum(loss - half, loss / 2), "high": loss + half}
            looks[label] = {"color": colour, "linewidth": 1.5, "linestyle": DASHES[row["part"]]}
    draw_curves(
        axes, None, series, looks=looks, title=f"policies counted: {source}", xlabel="task", logarithmic="y",
        legend=False,
    )  # fmt: skip
    axes.invert_yaxis()


def _draw_learning_on(axes: Axes, result: Mapping, source: str) -> None:
    """Reward below the optimum over the episodes of the last tasks, by method."""
    (edges,) = (np.array(row["curve_edges"]) for row in result["rows"] if "curve_edges" in row)
    for row in result["rows"]:
        if "loss_of" in row and row["loss_source"] == source:
            words, colour = METHODS[row["loss_of"]]
            axes.plot(block_centres(edges), row["mean"], color=colour, label=words)
    axes.axvline(result["settings"]["episodes"], color=GREY, linewidth=0.8, linestyle=(0, (1, 2)))
    axes.set_xscale("log")
    axes.set_yscale("symlog", linthresh=10.0)
    axes.set_ylim(1e6, 0)
    axes.set(title=f"learnt on: {source}", xlabel="episode")


def _draw_tables(panels: Sequence[Axes], result: Mapping) -> None:
    """A table for each difference: a row for each source and cap, a column for each ε and ties."""
    settings = result["settings"]
    judged = OF_E4 if OF_E4 in settings["sources"] else settings["default"]["source"]
    framed = {**settings, "default": {**settings["default"], "source": judged}}
    cells = [row for row in result["rows"] if "first_uniform" in row]
    for axes, (difference, title) in zip(panels, TABLES.items(), strict=True):
        draw_choice_grid(
            axes, framed, cells, f"{difference}_of_distance", ("source", "max_steps"), "{}; cap {:,}".format,
            neutral=0.0, scale=100.0, spread=100.0, words="{:z.0f}".format,
        )  # fmt: skip
        axes.set_title(title)
        if axes is not panels[0]:
            axes.set_yticklabels([])
