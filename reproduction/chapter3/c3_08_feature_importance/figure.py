"""Figure of claim C3.8: how much entropy each feature saves in each set, and over the choices left open."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.heat_grid import draw_heat_grid, frame_cells
from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import GREY, LIGHT, Axes, Figure, colour_of, house_style, new_figure
from reproduction.chapter3.factory.modified_tasks import FEATURES
from reproduction.chapter3.figures.choice_grid import place_of_default
from reproduction.chapter3.figures.feature_words import features_in_words

OVER = {"all": "all states", "way": "states of an optimal way"}
ACTIONS = {"tied": "all best actions", "first": "the first best action"}


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    figure = new_figure(10.2, 7.6)
    upper, lower = figure.subplots(2, 1, height_ratios=[1.0, 0.9])
    cells, at = result["rows"], place_of_default(result["rows"], result["settings"])
    _draw_bars(upper, cells[at]["increase"])
    _draw_grid(lower, cells, at)
    for axes in (upper, lower):
        axes.axvline(3.5, color=GREY, linewidth=0.8)
    figure.supxlabel(
        f"Lines: 95 % interval over {result['settings']['runs']} runs. Bold: selected by Alg. 5 in at least 95 % "
        "of runs.\nFramed: the default. N to SE: the cell in that direction of the robot's own. Left of the line: "
        "φ2.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_bars(axes: Axes, increase: Mapping[str, Mapping]) -> None:
    names = {phi: phi.replace("phi", "φ") for phi in increase}
    groups = {names[phi]: [of_feature.get(name) for name in FEATURES] for phi, of_feature in increase.items()}
    colours = {name: colour_of(phi) for phi, name in names.items()}
    draw_interval_bars(
        axes, features_in_words(FEATURES), groups, colours=colours, horizontal=False, words=None,
        title="Importance of each feature in the sets that contain it", label="Δ, bits lost without the feature",
    )  # fmt: skip
    axes.axhline(0, color=GREY, linewidth=0.8)
    axes.grid(axis="y", color=LIGHT)
    axes.set_xlim(-0.5, len(FEATURES) - 0.5)
    axes.legend(loc="upper right", ncols=4)


def _draw_grid(axes: Axes, cells: list[Mapping], at: int) -> None:
    values = [[1000 * row["increase"]["phi4"][f]["value"] for f in FEATURES] for row in cells]
    selected = [[row["selected"][f] >= 0.95 for f in FEATURES] for row in cells]
    sides = [f"{row['policies']} policies, {OVER[row['over']]},\n{ACTIONS[row['actions']]}" for row in cells]
    most = float(np.max(np.abs(values))) or 1.0
    draw_heat_grid(
        axes, values, selected, sides, features_in_words(FEATURES), neutral=0.0, spread=most,
        words="{:.0f}".format,
    )  # fmt: skip
    frame_cells(axes, (at, 0), (1, len(FEATURES)))
    axes.set_title("Δ in φ4, thousandths of a bit, by what is counted")
