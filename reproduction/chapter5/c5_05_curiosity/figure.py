"""Points missed on new orders after spare time, and signs of a type that arrives late."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREY, VERMILION, Axes
from reproduction.chapter5.c5_05_curiosity.run import CURIOUS, UNIFORM
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

LABELS = {UNIFORM: "uniform replay", CURIOUS: "by entropy × frequency"}
LOOKS = {"uniform replay": {"color": GREY}, "by entropy × frequency": {"color": BLUE, "linewidth": 2.2}}
XLABELS = {"spread at the end": "entropy of the belief (nats)", "alarm": "score of the detector"}
BINS = 12


@panels(11.0, 3.4, 1, 3, width_ratios=(1.3, 1, 1), grid="")
def draw(result: Mapping, axes: Axes, *beside: Axes) -> None:
    """The figure from the result."""
    settings = result["settings"]
    series = {LABELS[row["chooser"]]: row for row in result["rows"] if "chooser" in row}
    orders = settings["span"] * np.arange(settings["spans"] + 1)
    draw_curves(axes, orders, series, looks=LOOKS, title="Practice in spare time", xlabel="spare orders")
    axes.set_ylabel("points below the best return")
    axes.set_ylim(bottom=0)
    axes.grid(axis="y")
    for panel, row in zip(beside, (row for row in result["rows"] if "sign" in row), strict=True):
        _draw_sign(panel, row)
    beside[0].set_ylabel("share of tasks (%)")
    beside[1].legend(loc="upper right")


def _draw_sign(axes: Axes, row: Mapping) -> None:
    """Spread of a sign in tasks of known types and in the first task of the late type."""
    edges = np.linspace(0, max([*row["known"], *row["late"], 1e-9]), BINS + 1).tolist()
    for name, colour in (("known", GREY), ("late", VERMILION)):
        values = row[name]
        label = "known types" if name == "known" else "unseen type"
        weights = np.full(len(values), 100 / max(len(values), 1))
        axes.hist(values, edges, weights=weights, color=colour, alpha=0.6, label=label)
    title = "Spread of the belief" if "spread" in row["sign"] else "Unexplained effects"
    axes.set(title=title, xlabel=XLABELS[row["sign"]])
