"""Figure of claim C3.8: how much entropy each feature saves in each set, and over the choices left open."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter3.feature_curves import COLOURS
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import GREY, INK, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FEATURES = ("PosUM", "PosML", "PosMR", "PosDM", "PosMM", "PosUL", "PosUR", "PosDL", "PosDR", "Items")
"""First the four that the thesis finds to matter, then the others."""
_SETS = ("phi1", "phi2", "phi3", "phi4")
_OVER = {"all": "all states", "way": "states of an optimal way"}
_ACTIONS = {"tied": "all best actions", "first": "the first best action"}


def draw_feature_bars(result: Mapping) -> "Figure":
    """The figure from the result of C3.8."""
    with house_style():
        figure = new_figure(10.2, 7.6)
        upper, lower = figure.subplots(2, 1, height_ratios=[1.0, 0.9])
        _draw_bars(upper, result)
        _draw_grid(lower, result)
        runs = result["settings"]["runs"]
        figure.supxlabel(
            f"Lines: 95 % interval over {runs} runs. Bold: selected by Alg. 5 in at least 95 % of runs. "
            "Framed, at PosUM: the default. Left of the line: N, W, E and S.",
            fontsize=8, color=GREY,
        )  # fmt: skip
    return figure


def _draw_bars(axes: "Axes", result: Mapping) -> None:
    measured = result["measured"]
    for i, phi in enumerate(_SETS):
        places = [k + 0.2 * (i - 1.5) for k, f in enumerate(FEATURES) if f"delta_{phi}_{f}" in measured]
        numbers = [measured[f"delta_{phi}_{f}"] for f in FEATURES if f"delta_{phi}_{f}" in measured]
        values = [number["value"] for number in numbers]
        axes.bar(places, values, width=0.19, color=COLOURS[phi], label=phi.replace("phi", "φ"), zorder=2)
        for place, number in zip(places, numbers, strict=True):
            if number["ci95"]:
                axes.plot([place, place], number["ci95"], color=INK, linewidth=1.1, zorder=3)
    axes.axvline(3.5, color=GREY, linewidth=0.8)
    axes.axhline(0, color=GREY, linewidth=0.8)
    axes.set_xticks(range(len(FEATURES)), FEATURES)
    axes.tick_params(axis="x", length=0)
    axes.grid(axis="y", color=LIGHT)
    axes.set(ylabel="Δ, bits lost without the feature", xlim=(-0.5, len(FEATURES) - 0.5))
    axes.set_title("Importance of each feature in the sets that contain it")
    axes.legend(loc="upper right", ncols=4)


def _draw_grid(axes: "Axes", result: Mapping) -> None:
    cells, default = result["rows"], result["settings"]["default"]
    values = [[1000 * row["increase"]["phi4"][f]["value"] for f in FEATURES] for row in cells]
    selected = [[row["selected"][f] >= 0.95 for f in FEATURES] for row in cells]
    is_default = [all(row[key] == value for key, value in default.items()) for row in cells]
    sides = [f"{row['policies']} policies, {_OVER[row['over']]},\n{_ACTIONS[row['actions']]}" for row in cells]
    draw_heat_grid(
        axes, values, selected, sides, FEATURES, neutral=0.0, spread=float(np.max(np.abs(values))) or 1.0,
        words=lambda value: f"{value:.0f}".replace("-", "−"), outlined=(is_default.index(True), 0),
    )  # fmt: skip
    axes.axvline(3.5, color=GREY, linewidth=0.8)
    axes.set_title("Δ in φ4, thousandths of a bit, by what is counted")
