"""Figure of claim C3.10: the share of runs in which each feature is chosen, after each task."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREY, PAPER, Axes, Figure, house_style, new_figure
from reproduction.chapter3.factory.modified_tasks import FEATURES
from reproduction.chapter3.figures.feature_words import features_in_words

COLUMNS = 4
TITLES = {
    "exact": "exact, all states",
    "learnt": "learnt, states tried",
    "learnt, promising": "learnt, states that promise a reward",
    "exact, on the way": "exact, states of an optimal way",
    "learnt longer": "learnt longer, states tried",
}


@house_style()
def draw(result: Mapping) -> Figure:
    """A panel for each series, a row for each feature."""
    series, settings = result["rows"], result["settings"]
    n_rows = -(-len(series) // COLUMNS)
    figure = new_figure(12.6, 0.7 + 2.5 * n_rows)
    panels = figure.subplots(n_rows, COLUMNS, squeeze=False, sharex=True, sharey=True).ravel()
    images = [_draw_series(axes, row) for axes, row in zip(panels, series, strict=False)]
    for axes in panels[len(series) :]:
        axes.set_axis_off()
    for axes in panels[max(0, len(series) - COLUMNS) : len(series)]:
        axes.set_xlabel("tasks")
        axes.tick_params(labelbottom=True)
    figure.colorbar(images[0], ax=list(panels), shrink=0.5, pad=0.01, label="share of runs")
    figure.supxlabel(
        f"{settings['runs']} runs. Learnt: {settings['episodes']} episodes a task, longer: "
        f"{settings['long_episodes']}. N to SE: the cell in that direction of the robot's own. "
        "Above the line: φ2.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_series(axes: Axes, row: Mapping):
    from matplotlib.colors import LinearSegmentedColormap

    shares = np.array([row["shares"][feature] for feature in FEATURES])
    image = axes.imshow(
        shares, cmap=LinearSegmentedColormap.from_list("share", [PAPER, BLUE]), vmin=0, vmax=1, aspect="auto",
        interpolation="nearest", extent=(0.5, shares.shape[1] + 0.5, len(FEATURES) - 0.5, -0.5),
    )  # fmt: skip
    axes.axhline(3.5, color=GREY, linewidth=1.0)
    axes.set_yticks(range(len(FEATURES)), features_in_words(FEATURES))
    axes.tick_params(axis="y", length=0)
    axes.set_title(TITLES.get(row["series"]) or str(row["series"]), fontsize=9)
    return image
