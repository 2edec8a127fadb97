"""Figure of claim C3.9: first and last episode of each task, with selected features, with all ten and without."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import BLUE, GREY, INK, PURPLE, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_first_and_last(result)


_COLOURS = {"uniform": GREY, "full": PURPLE, "selected": BLUE}
_LABELS = {"uniform": "no prior", "full": "all ten features", "selected": "selected features"}
_DASHES = {"first": "-", "last": (0, (4, 2))}


def draw_first_and_last(result: Mapping) -> "Figure":
    """The figure from the result of C3.9."""
    settings = result["settings"]
    with house_style():
        figure = new_figure(11.0, 6.8)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[1.0, 0.62], hspace=0.02)[:, 0]
        panels = upper.subplots(1, len(settings["sources"]), squeeze=False, sharey=True)[0]
        for axes, source in zip(panels, settings["sources"], strict=True):
            _draw_source(axes, result, source)
        panels[0].set_ylabel("reward of an episode, thousands")
        upper.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=7)
        _draw_grids(lower.subplots(1, 2, sharey=True), result)
        lower.supxlabel(
            f"Shaded: one standard deviation between {settings['runs']} runs. Dashed: episode "
            f"{settings['episodes']}. Means over the tasks after the first; framed: the default.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_source(axes: "Axes", result: Mapping, source: str) -> None:
    curves = [row for row in result["rows"] if row.get("of_source") == source]
    for row in curves:
        colour, part = _COLOURS[row["curve_of"]], row["part"]
        mean, deviation = np.array(row["mean"]) / 1000, np.array(row["deviation"]) / 1000
        tasks = np.arange(1, len(mean) + 1)
        axes.fill_between(tasks, mean - deviation, mean + deviation, color=colour, alpha=0.13, linewidth=0)
        label = f"{_LABELS[row['curve_of']]}, {part}"
        axes.plot(tasks, mean, color=colour, label=label, linewidth=1.5, linestyle=_DASHES[part])
    optimal = result["measured"]["optimal_reward"]["value"] / 1000
    axes.axhline(optimal, color=INK, linestyle=(0, (1, 2)), linewidth=1.2, label="optimal", zorder=1)
    axes.set(xlabel="task", title=f"policies counted: {source}")


def _draw_grids(panels, result: Mapping) -> None:
    default, methods = result["settings"]["default"], list(_COLOURS)
    cells = [row for row in result["rows"] if "of_source" not in row]
    sides = [_in_words(row, default) for row in cells]
    is_default = [all(row[key] == value for key, value in default.items()) for row in cells]
    for axes, part in zip(panels, _DASHES, strict=True):
        values = np.array([[row[f"{part}_{method}"] for method in methods] for row in cells]) / 1000
        # Shaded by how much of the row's own worst is left: rows differ by the cap and ε.
        worst = np.maximum(np.abs(values).max(axis=1, keepdims=True), 1e-9)
        _draw_values(axes, values, 1 - np.abs(values) / worst, sides, is_default.index(True))
        axes.set_title(f"Reward of the {part} episode, thousands")


def _draw_values(axes: "Axes", values: np.ndarray, better: np.ndarray, sides: list[str], framed: int) -> None:
    words = iter(f"{value:,.1f}".replace("-", "−") for value in values.ravel())
    draw_heat_grid(
        axes, better, np.zeros(values.shape, bool), sides, list(_LABELS.values()), neutral=0.0, spread=1.0,
        words=lambda _: next(words), outlined=(framed, 2),
    )  # fmt: skip


def _in_words(row: Mapping, default: Mapping) -> str:
    """What in a row of the grid differs from the default."""
    first, decay, _ = row["schedule"]
    words = {
        "source": f"policies {row['source']}",
        "schedule": f"ε {first:g}" if decay == 1 else f"ε {first:g} × {decay:g}",
        "ties": f"ties {row['ties']}",
        "max_steps": f"cap of {row['max_steps']:,} steps",
    }
    return next((words[key] for key in words if row[key] != default[key]), f"default: {words['source']}")
