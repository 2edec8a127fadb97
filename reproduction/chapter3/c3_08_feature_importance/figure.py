"""Figure of claim C3.8: how much entropy each feature saves in each set of features."""

from collections.abc import Mapping

from lifelore.domains.factory.contexts import PHI
from lifelore.figures.style import GREY, Axes, colour_of
from reproduction.chapter3.factory.modified_tasks import FEATURES
from reproduction.chapter3.figures.feature_words import features_in_words
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

COLOURS = {phi.replace("phi", "φ"): colour_of(phi) for phi in PHI}
TICKS = features_in_words(FEATURES)


@panels(8.0, 3.8)
def draw(result: Mapping, axes: Axes) -> None:
    """Bars of each feature, one for each set that contains it."""
    number = {(row["set"], row["feature"]): row for row in result["rows"]}
    groups = {phi.replace("phi", "φ"): [number.get((phi, feature)) for feature in FEATURES] for phi in PHI}
    draw_interval_bars(
        axes, TICKS, groups, colours=COLOURS, horizontal=False, words=None,
        label="Δ, bits lost without the feature",
    )  # fmt: skip
    axes.axhline(0, color=GREY, linewidth=0.8)
    axes.legend(loc="upper right", ncols=4)
    axes.figure.supxlabel(
        f"{result['settings']['runs']} runs; lines: 95 % interval. N to SE: cells around the robot's.",
        fontsize=8, color=GREY,
    )  # fmt: skip
