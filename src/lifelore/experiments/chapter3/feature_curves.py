"""Figure of claim C3.7: what priors over features earn beside one over states and none, and over open choices."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter3.reward_curves import draw_reward_curves
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {"uniform": GREY, "state": VERMILION, "phi1": ORANGE, "phi2": GREEN, "phi3": BLUE, "phi4": PURPLE}
LABELS = {
    "uniform": "no prior",
    "state": "states",
    "phi1": "φ1, own cell and Items",
    "phi2": "φ2, N S E W",
    "phi3": "φ3, φ1 and φ2",
    "phi4": "φ4, 3×3 cells and Items",
}
_BANDED = ("uniform", "state", "phi3")
"""Whose deviation is shaded; six bands would hide one another."""


def draw_feature_curves(result: Mapping) -> "Figure":
    """The figure from the result of C3.7."""
    schedules = result["settings"]["schedules"]
    with house_style():
        figure = new_figure(10.6, 8.4)
        upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[1.0, 0.82], hspace=0.02)[:, 0]
        panels = upper.subplots(1, len(schedules), squeeze=False, sharey=True)[0]
        for axes, schedule in zip(panels, schedules, strict=True):
            draw_reward_curves(axes, result, schedule, COLOURS, LABELS, banded=_BANDED, dashed=("phi2",))
        panels[0].set_ylabel("reward of an episode")
        upper.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=7)
        _draw_grid(lower.subplots(), result)
        settings = result["settings"]
        lower.supxlabel(
            f"{settings['runs']} runs of {settings['test_tasks']} tasks. Shaded: one standard deviation between "
            "runs, of three methods. Bold: the 95 % interval over runs excludes 0. Framed, at φ3: "
            "the default.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_grid(axes: "Axes", result: Mapping) -> None:
    default, methods = result["settings"]["default"], list(COLOURS)[1:]
    cells = [row for row in result["rows"] if "closed_phi1" in row]
    numbers = [[row[f"closed_{method}"] for method in methods] for row in cells]
    values = [[np.nan if n["value"] is None else 100 * n["value"] for n in row] for row in numbers]
    certain = [[bool(n["ci95"]) and not n["ci95"][0] <= 0 <= n["ci95"][1] for n in row] for row in numbers]
    is_default = [all(row[key] == value for key, value in default.items()) for row in cells]
    draw_heat_grid(
        axes, values, certain, [_in_words(row, default) for row in cells], [LABELS[m] for m in methods],
        neutral=0.0, spread=100.0, words=_percent, outlined=(is_default.index(True), methods.index("phi3")),
    )  # fmt: skip
    axes.set_title("Distance from no prior to the optimum that is closed, all episodes (%)")


def _percent(value: float) -> str:
    return f"{value:.0f}".replace("-", "−")


def _in_words(row: Mapping, default: Mapping) -> str:
    """What a row of the grid is: ε and ties, or what else in it differs from the default."""
    others = {
        "encoding": "states coded '{}'", "alpha0": "α⁰ {:g}", "max_steps": "cap of {:,} steps",
        "policies": "from {} policies",
    }  # fmt: skip
    for key, words in others.items():
        if row[key] != default[key]:
            return words.format(row[key])
    first, decay, _ = row["schedule"]
    epsilon = f"ε {first:g}" if decay == 1 else f"ε {first:g} × {decay:g}"
    return f"{epsilon}, ties {row['ties']}"
