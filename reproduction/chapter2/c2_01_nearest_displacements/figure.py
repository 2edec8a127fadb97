"""The printed confusion matrix beside ours, of simulated and of real pairs (Figure 2.5)."""

from collections.abc import Mapping

import numpy as np

from lifelore.core.relations import CORE_RELATIONS
from lifelore.figures.style import BLUE, GREY, INK, PAPER, VERMILION, Axes, Figure, new_figure

PRINTED = [[64, 6, 13, 0], [2, 20, 5, 0], [4, 5, 12, 0], [0, 1, 0, 0]]
"""Figure 2.5: predicted by actual, in the order of `CORE_RELATIONS`."""


def draw(result: Mapping) -> Figure:
    """The matrices side by side."""
    matrices = {"thesis, printed": PRINTED}
    matrices |= {f"here, {row['confusion']} pairs": row["predicted_by_actual"] for row in result["rows"]}
    figure = new_figure(9.6, 3.5)
    every = figure.subplots(1, len(matrices), squeeze=False)[0]
    for axes, (title, matrix) in zip(every, matrices.items(), strict=True):
        draw_confusion(axes, np.asarray(matrix), title)
    return figure


def draw_confusion(axes: Axes, counts: np.ndarray, title: str) -> None:
    """A matrix, its diagonal blue and the rest vermilion, by the share of the column."""
    from matplotlib.colors import LinearSegmentedColormap

    labels, actual = CORE_RELATIONS, counts.sum(axis=0)
    share = counts / np.maximum(1, actual)
    signed = np.where(np.eye(len(labels), dtype=bool), share, -share)
    shades = LinearSegmentedColormap.from_list("right or wrong", [VERMILION, PAPER, BLUE])
    axes.imshow(signed, cmap=shades, vmin=-1.15, vmax=1.15)
    for (row, column), count in np.ndenumerate(counts):
        colour = GREY if count == 0 else PAPER if share[row, column] > 0.62 else INK
        weight = "bold" if row == column else "normal"
        axes.text(column, row, f"{count:g}", ha="center", va="center", color=colour, fontweight=weight)
    recalls = [f"{100 * share[k, k]:.0f} %" if n else "–" for k, n in enumerate(actual)]
    axes.set_xticks(range(len(labels)), [f"{label}\n{part}" for label, part in zip(labels, recalls, strict=True)])
    axes.set_yticks(range(len(labels)), labels)
    axes.set(xlabel="actual, with its recall", ylabel="predicted")
    axes.set_title(f"{title}\n{np.trace(counts):g} of {counts.sum():g} right", fontsize=9)
    axes.tick_params(which="both", length=0)
    axes.spines[:].set_visible(False)
