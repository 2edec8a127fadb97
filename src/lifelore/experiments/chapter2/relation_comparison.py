"""Confusion matrices beside the thesis's printed one, and under them how often each method is exact (Fig 2.5)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.experiments.chapter2.confusion_matrix import draw_confusion
from lifelore.experiments.chapter2.method_bars import draw_bars
from lifelore.figures.style import house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_relation_comparison(
    rows: Sequence[Mapping], printed: Sequence[Sequence[int]], labels: Sequence[str]
) -> "Figure":
    """The figure, from the rows of a result: ``{"confusion", "predicted_by_actual"}`` and ``{"method", …}``."""
    matrices = {"thesis, printed": printed} | {
        f"{row['confusion']}, A and B given": row["predicted_by_actual"] for row in rows if "confusion" in row
    }
    panels: dict[str, dict[str, Mapping]] = {}
    for row in rows:
        if "method" in row:
            panels.setdefault(row["scenes"], {})[row["method"]] = row["exact"]
    with house_style():
        figure = new_figure(9.6, 6.3)
        top, bottom = figure.subfigures(2, 1, squeeze=False, height_ratios=[3.3, 2.5])[:, 0]
        for axes, (title, matrix) in zip(
            np.atleast_1d(top.subplots(1, len(matrices))), matrices.items(), strict=True
        ):
            draw_confusion(axes, np.asarray(matrix), labels, title)
        draw_bars(bottom, {f"{name}, direction inferred": panel for name, panel in panels.items()})
    return figure
