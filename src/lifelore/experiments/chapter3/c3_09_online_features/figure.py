"""Figure of claim C3.9: first and last episode of each task, with selected features, with all ten and without."""

from collections.abc import Mapping

import numpy as np

from lifelore.experiments.chapter3.figures.choice_grid import other_choice, place_of_default
from lifelore.experiments.chapter3.learning.schedules import schedule_in_brief
from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import BLUE, GREY, PURPLE, Axes, Figure, house_style, new_figure, two_rows

METHODS = {"uniform": ("no prior", GREY), "full": ("all ten features", PURPLE)}
METHODS |= {"selected": ("selected features", BLUE)}
"""Label and colour by method."""
PARTS = ("first", "last")
"""A row of panels each: the last episodes are alike to a small part of what the first ones differ by."""


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    settings = result["settings"]
    figure = new_figure(11.0, 8.6)
    upper, lower = two_rows(figure, (1.0, 0.4))
    panels = upper.subplots(2, len(settings["sources"]), squeeze=False, sharey="row", height_ratios=(1.15, 1))
    names = {"first": "first episode", "last": f"episode {settings['episodes']}"}
    for row, part in zip(panels, PARTS, strict=True):
        for axes, source in zip(row, settings["sources"], strict=True):
            _draw_source(axes, result, source, part, f"{source}: {names[part]}")
        row[0].set_ylabel("reward, thousands")
    upper.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper left", ncols=4)
    for axes, part in zip(lower.subplots(1, 2, sharey=True), PARTS, strict=True):
        _draw_grid(axes, result, part)
    lower.supxlabel(
        f"Columns: which policies are counted. Shaded: one standard deviation between {settings['runs']} runs; "
        "last episodes without. Tables: means over the tasks after the first; framed: the default.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_source(axes: Axes, result: Mapping, source: str, part: str, title: str) -> None:
    series, looks = {}, {}
    for row in result["rows"]:
        if row.get("of_source") == source and row["part"] == part:
            label, colour = METHODS[row["curve_of"]]
            keys = ("mean", "deviation") if part == "first" else ("mean",)
            series[label] = {key: np.array(row[key]) / 1000 for key in keys}
            looks[label] = {"color": colour, "linewidth": 1.5}
    draw_curves(
        axes, None, series, looks=looks, title=title, xlabel="task",
        level=(result["measured"]["optimal_reward"]["value"] / 1000, "optimal"), legend=False,
    )  # fmt: skip


def _draw_grid(axes: Axes, result: Mapping, part: str) -> None:
    default = result["settings"]["default"]
    cells = [row for row in result["rows"] if "of_source" not in row]
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
