"""Figure of claim C3.19: the features that are acquired, and learning with them."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.curves import draw_curves
from lifelore.figures.heat_grid import frame_cells
from lifelore.figures.style import BLUE, GREEN, GREY, INK, PAPER, VERMILION, Axes, Figure, house_style, new_figure
from reproduction.chapter3.c3_19_acquired_features.run import NOISE
from reproduction.chapter3.factory.modified_tasks import FEATURES
from reproduction.chapter3.figures.feature_words import features_in_words
from reproduction.engine.results_table import BAND

LABELS = {
    "uniform": "no prior",
    "start": "own cell and items, at the start",
    "acquired": "acquired",
    "all": "all ten",
}
COLOURS = {"uniform": GREY, "start": VERMILION, "acquired": BLUE, "all": GREEN}
START_NAMES = {"phi1": "own cell, items", "items": "items", "north": "N, items"}


@house_style()
def draw(result: Mapping) -> Figure:
    """The shares of runs in which each feature is acquired, by cell of the grid; rewards at the default."""
    figure = new_figure(11.2, 4.4)
    left, right = figure.subplots(1, 2, width_ratios=(1.15, 1))
    _draw_shares(left, result)
    curves = {row["curve_of"]: row for row in result["rows"] if "curve_of" in row}
    series = {LABELS[name]: {part: curves[name][part] for part in BAND} for name in LABELS}
    looks = {LABELS[name]: {"color": COLOURS[name], "linewidth": 1.6} for name in LABELS}
    draw_curves(
        right, None, series, looks=looks, title="Learning in new factories, by the features of the prior",
        xlabel="episode", ylabel="reward of an episode", logarithmic="x",
    )  # fmt: skip
    right.xaxis.set_major_formatter("{x:g}")
    right.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
    figure.supxlabel(
        f"{result['settings']['runs']} runs of {result['settings']['tasks']} tasks, then "
        f"{result['settings']['test_tasks']} new ones. Shaded: 95 % intervals. "
        "Framed: the default.\nN to SE: the cell in that direction of the robot's own. Above the line: φ2. "
        "·: known from the start. ω: least importance of a feature that is acquired.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_shares(axes: Axes, result: Mapping) -> None:
    from matplotlib.colors import LinearSegmentedColormap

    names, default = (*FEATURES, *NOISE), result["settings"]["default"]
    cells = [row for row in result["rows"] if "shares" in row]
    shares = np.array(
        [[np.nan if row["shares"][name] is None else row["shares"][name] for row in cells] for name in names]
    )
    axes.imshow(
        np.nan_to_num(shares), cmap=LinearSegmentedColormap.from_list("share", [PAPER, BLUE]), vmin=0, vmax=1,
        aspect="auto", interpolation="nearest",
    )  # fmt: skip
    for (row, column), share in np.ndenumerate(shares):
        words = "·" if np.isnan(share) else f"{100 * share:.0f}"
        axes.text(column, row, words, ha="center", va="center", fontsize=7.5, color=PAPER if share > 0.6 else INK)
    axes.axhline(3.5, color=GREY, linewidth=1.0)
    at = next(i for i, row in enumerate(cells) if all(row[key] == default[key] for key in default))
    frame_cells(axes, (0, at), (len(names), 1))
    axes.set_yticks(range(len(names)), features_in_words(names))
    ticks = [f"{START_NAMES[row['start']]}\nω {row['least']:g}" for row in cells]
    axes.set_xticks(range(len(cells)), ticks, rotation=60, ha="right", rotation_mode="anchor", fontsize=7)
    axes.tick_params(length=0)
    axes.set_title("Runs in which a feature is acquired (%)")
