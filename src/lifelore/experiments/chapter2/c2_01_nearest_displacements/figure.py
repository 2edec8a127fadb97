"""Confusion matrices beside the printed matrix, and below them how often each method is exact (Figure 2.5)."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.core.relations import CORE_RELATIONS
from lifelore.experiments.chapter2.scoring.method_panels import draw_method_panels
from lifelore.figures.style import BLUE, GREY, INK, PAPER, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PRINTED = [[64, 6, 13, 0], [2, 20, 5, 0], [4, 5, 12, 0], [0, 1, 0, 0]]
"""Figure 2.5: predicted by actual, in the order of `CORE_RELATIONS`."""


def draw(result: Mapping) -> "Figure":
    matrices = {"thesis, printed": PRINTED}
    panels: dict[str, dict[str, Mapping]] = {}
    for row in result["rows"]:
        if "confusion" in row:
            matrices[f"{row['confusion']}, A and B given"] = row["predicted_by_actual"]
        elif "method" in row:
            panels.setdefault(f"{row['scenes']}, direction inferred", {})[row["method"]] = row["exact"]
    with house_style():
        figure = new_figure(9.6, 6.3)
        top, bottom = figure.subfigures(2, 1, squeeze=False, height_ratios=[3.3, 2.5])[:, 0]
        every = np.atleast_1d(top.subplots(1, len(matrices)))
        for axes, (title, matrix) in zip(every, matrices.items(), strict=True):
            draw_confusion(axes, np.asarray(matrix), title)
        draw_method_panels(bottom, panels)
    return figure


def draw_confusion(axes: "Axes", counts: np.ndarray, title: str) -> None:
    """A matrix, its diagonal blue and the rest vermilion, by the share of the column."""
    from matplotlib.colors import LinearSegmentedColormap

    labels, size, actual = CORE_RELATIONS, len(CORE_RELATIONS), counts.sum(axis=0)
    share = counts / np.maximum(1, actual)
    signed = np.where(np.eye(size, dtype=bool), share, -share)
    shades = LinearSegmentedColormap.from_list("right or wrong", [VERMILION, PAPER, BLUE])
    axes.imshow(signed, cmap=shades, vmin=-1.15, vmax=1.15)
    for (row, column), count in np.ndenumerate(counts):
        colour = GREY if count == 0 else PAPER if share[row, column] > 0.62 else INK
        weight = "bold" if row == column else "normal"
        axes.text(column, row, f"{count:g}", ha="center", va="center", color=colour, fontweight=weight)
    recalls = [
        f"{label}\n{100 * share[k, k]:.0f} %" if actual[k] else f"{label}\n–" for k, label in enumerate(labels)
    ]
    axes.set_xticks(range(size), recalls)
    axes.set_yticks(range(size), labels)
    axes.set(xlabel="actual, with its recall", ylabel="predicted")
    axes.set_title(f"{title}\n{np.trace(counts):g} of {counts.sum():g} right", fontsize=9)
    axes.tick_params(which="both", length=0)
    axes.spines[:].set_visible(False)
