"""Pictures of worlds side by side, each under its title; and the prior that a few walks leave."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.figures.lives.prior_arrows import draw_prior
from lifelore.figures.style import VERMILION, house_style, new_figure

COLUMNS = 4


def draw_world_plates(plates: Sequence[tuple[str, ArrayLike]], walked: Mapping | None = None):
    """Draw worlds, four in a row: titles with pictures, each (height, width, 3) uint8.

    `walked` adds a last plate: ``{"title", "shape", "cells", "probs", "walks"}``, the prior over a small grid (see
    `draw_prior`) with the walks, each (n, 2) rows and columns, that it comes from; no arrows without mass.
    """
    if not plates:
        raise InputError("plates must be at least one, got none")
    n = len(plates) + (walked is not None)
    rows = -(-n // COLUMNS)
    with house_style():
        figure = new_figure(2.6 * min(n, COLUMNS), 2.85 * rows)
        axes = figure.subplots(rows, min(n, COLUMNS), squeeze=False).ravel()
        for panel, (title, picture) in zip(axes, plates, strict=False):
            panel.imshow(np.asarray(picture, np.uint8), interpolation="nearest")
            panel.set_title(title)
        if walked is not None:
            _draw_walked(axes[n - 1], walked)
        for panel in axes:
            panel.axis("off")
    return figure


def _draw_walked(axes, walked: Mapping) -> None:
    probs = np.asarray(walked["probs"], float)
    draw_prior(axes, walked["shape"], walked["cells"], probs, probs.any(axis=1))
    for number, walk in enumerate(walked["walks"]):
        row, column = np.asarray(walk, float).T + 0.08 * (number - (len(walked["walks"]) - 1) / 2)
        axes.plot(column, row, color=VERMILION, linewidth=1.2, alpha=0.7, zorder=3)
    axes.set_title(walked["title"])
