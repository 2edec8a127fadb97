"""Figure of claim C3.9: reward lost in the first and the last episode of each task, and when it is learnt on."""

from collections.abc import Mapping

import numpy as np

from lifelore.experiments.chapter3.figures.choice_grid import other_choice, place_of_default
from lifelore.experiments.chapter3.learning.schedules import schedule_in_brief
from lifelore.experiments.engine.curve_blocks import block_centres
from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import BLUE, GREY, PURPLE, Axes, Figure, house_style, new_figure, two_rows

METHODS = {"uniform": ("no prior", GREY), "full": ("all ten features", PURPLE)}
METHODS |= {"selected": ("selected features", BLUE)}
"""Label and colour by method."""
DASHES = {"first": "-", "last": (0, (4, 2))}


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    settings = result["settings"]
    figure = new_figure(12.0, 7.4)
    upper, lower = two_rows(figure, (1.0, 0.75))
    panels = upper.subplots(1, len(settings["sources"]), squeeze=False, sharey=True)[0]
    for axes, source in zip(panels, settings["sources"], strict=True):
        _draw_source(axes, result, source)
    panels[0].set_ylabel("reward below the optimum")
    upper.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=6)
    first, last, on = lower.subplots(1, 3, width_ratios=(1.0, 1.0, 1.15))
    for axes, part in ((first, "first"), (last, "last")):
        _draw_grid(axes, result, part)
    last.set_yticklabels([])
    _draw_learning_on(on, result)
    lower.supxlabel(
        f"Shaded, first episodes: one standard deviation between {settings['runs']} runs. Dashed: episode "
        f"{settings['episodes']}. Means over the tasks after the first; framed: the default. Promising: counted "
        f"as E4 says.\nLearnt on: the last {settings['long_tasks']} tasks.",
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


def _draw_learning_on(axes: Axes, result: Mapping) -> None:
    """Reward below the optimum over the episodes of the last tasks, by method and by what is counted."""
    (edges,) = (np.array(row["curve_edges"]) for row in result["rows"] if "curve_edges" in row)
    centres, default = block_centres(edges), result["settings"]["default"]["source"]
    for row in result["rows"]:
        if "loss_of" in row and row["loss_source"] == default:
            words, colour = METHODS[row["loss_of"]]
            axes.plot(centres, row["mean"], color=colour, label=words)
    axes.axvline(result["settings"]["episodes"], color=GREY, linewidth=0.8, linestyle=(0, (1, 2)))
    axes.set_xscale("log")
    axes.set_yscale("symlog", linthresh=10.0)
    axes.set_ylim(1e6, 0)
    axes.set(title=f"Learnt on: {default}", xlabel="episode", ylabel="reward below the optimum")


def _draw_grid(axes: Axes, result: Mapping, part: str) -> None:
    default = result["settings"]["default"]
    cells = [row for row in result["rows"] if f"{part}_uniform" in row]
    values = np.array([[row[f"{part}_{method}"] for method in METHODS] for row in cells]) / 1000
    # Shaded by the share of the row's own worst value: rows differ by the cap and ε.
    worst = np.maximum(np.abs(values).max(axis=1, keepdims=True), 1e-9)
    words = iter(f"{value:,.1f}" for value in values.ravel())
    draw_heat_grid(
        axes, 1 - np.abs(values) / worst, np.zeros(values.shape, bool), [_name(row, default) for row in cells],
        [label for label, _ in METHODS.values()], neutral=0.0, spread=1.0, words=lambda _: next(words),
        outlined=(place_of_default(cells, result["settings"]), 2),
    )  # fmt: skip
    axes.set_title(f"Reward of the {part} episode, thousands")


def _name(row: Mapping, default: Mapping) -> str:
    """The choice in which a row of the grid differs from the default."""
    words = {"source": "policies {}", "ties": "ties {}", "max_steps": "cap of {:,} steps"}
    if row["schedule"] != default["schedule"]:
        return schedule_in_brief(row["schedule"])
    return other_choice(row, default, words) or f"default: policies {row['source']}"
