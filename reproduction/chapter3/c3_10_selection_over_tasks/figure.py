"""Figure of claim C3.10: the share of runs in which each feature is chosen, after each task."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import GREY, INK, PAPER, VERMILION, Axes
from reproduction.chapter3.c3_09_online_features.run import DRAWN
from reproduction.chapter3.factory.modified_tasks import FEATURES
from reproduction.chapter3.figures.feature_words import features_in_words
from reproduction.figures.panels import panels


@panels(6.8, 3.4, grid="")
def draw(result: Mapping, axes: Axes) -> None:
    """A row for each feature, the four of φ2 above the line; the brighter, the more runs."""
    from matplotlib.colors import LinearSegmentedColormap

    found = {row["feature"]: row["shares"] for row in result["rows"]}
    shares = np.array([found[feature] for feature in FEATURES])
    image = axes.imshow(
        shares, cmap=LinearSegmentedColormap.from_list("share", [INK, PAPER]), vmin=0, vmax=1, aspect="auto",
        interpolation="nearest", extent=(0.5, shares.shape[1] + 0.5, len(FEATURES) - 0.5, -0.5),
    )  # fmt: skip
    axes.axhline(3.5, color=VERMILION, linewidth=1.2)
    axes.set_yticks(range(len(FEATURES)), features_in_words(FEATURES))
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("tasks")
    axes.figure.colorbar(image, ax=axes, pad=0.02, label="share of runs")
    axes.figure.supxlabel(
        f"{min(DRAWN, result['settings']['runs'])} runs. N to SE: cells around the robot's. Above the line: φ2.",
        fontsize=8, color=GREY,
    )  # fmt: skip
