"""Confusion matrices as the thesis prints them, predicted by actual, with each class's recall (Fig 2.5)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.figures.style import BLUE, GREY, INK, PAPER, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw_confusions(matrices: Mapping[str, ArrayLike], labels: Sequence[str]) -> "Figure":
    """Matrices side by side; the diagonal blue and the rest vermilion, by the share of their column.

    Parameters
    ----------
    matrices : mapping of title to (k, k)
        Counts, row: predicted, column: actual.
    labels : sequence of str
        The k classes.

    Raises
    ------
    InputError
        A matrix is not k × k.
    """
    size = len(labels)
    for title, matrix in matrices.items():
        if np.shape(matrix) != (size, size):
            raise InputError(f"matrix '{title}' must have shape {(size, size)}, got {np.shape(matrix)}")
    with house_style():
        each = 0.75 + 0.58 * size
        figure = new_figure(each * len(matrices) + 0.4, each + 0.35)
        for axes, (title, matrix) in zip(
            figure.subplots(1, len(matrices), squeeze=False)[0], matrices.items(), strict=True
        ):
            draw_confusion(axes, np.asarray(matrix), labels, title)
    return figure


def draw_confusion(axes: "Axes", counts: np.ndarray, labels: Sequence[str], title: str) -> None:
    """One matrix, within the house style."""
    from matplotlib.colors import LinearSegmentedColormap

    size, actual = len(labels), counts.sum(axis=0)
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
    axes.set_xticks(np.arange(size + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(size + 1) - 0.5, minor=True)
    axes.grid(which="minor", color=PAPER, linewidth=2)
    axes.tick_params(which="both", length=0)
    axes.spines[:].set_visible(False)
