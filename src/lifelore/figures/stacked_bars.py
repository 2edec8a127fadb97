"""Stacked horizontal bars: the parts of a whole for each name, as counts or as shares."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.figures.style import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_stacked_bars(
    axes: "Axes",
    names: Sequence[str],
    parts: Mapping[str, ArrayLike],
    colours: Mapping[str, str],
    *,
    shares: bool = False,
    totals: bool = False,
    title: str = "",
    label: str = "",
) -> None:
    """Draw a bar for each name, its parts side by side in the order given.

    Parameters
    ----------
    axes : matplotlib axes
    names : sequence of str
        Ticks, top to bottom.
    parts : mapping
        Label → a count for each name, (n,).
    colours : mapping
        Label → colour.
    shares : bool
        Draw per cent of each bar's total instead of counts.
    totals : bool
        Write each bar's total at its end.
    title, label : str
        Title of the panel and label of the axis of values.

    Raises
    ------
    InputError
        A part has not one count for each name.
    """
    counts = {name: np.asarray(values, float) for name, values in parts.items()}
    for name, values in counts.items():
        if values.shape != (len(names),):
            raise InputError(f"part '{name}' must have shape ({len(names)},), got {values.shape}")
    total = sum(counts.values(), np.zeros(len(names)))
    scale = 100 / np.maximum(total, 1) if shares else np.ones(len(names))
    left = np.zeros(len(names))
    for name, values in counts.items():
        axes.barh(np.arange(len(names)), scale * values, left=left, height=0.74, color=colours[name], label=name)
        left += scale * values
    if totals:
        for place, (end, n) in enumerate(zip(left, total, strict=True)):
            axes.annotate(
                f"{n:g}", (end, place), (3, 0), textcoords="offset points", va="center", fontsize=7, color=INK,
                annotation_clip=False,
            )  # fmt: skip
    axes.set_yticks(range(len(names)), names)
    axes.set(title=title, xlabel=label, ylim=(len(names) - 0.5, -0.5), **({"xlim": (0, 100)} if shares else {}))
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
