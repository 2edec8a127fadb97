"""Displacements between contact points, seen from the front and coloured by relation (thesis Fig 2.4)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.figures.object_palette import mixed, relation_palette
from lifelore.figures.style import GREY, INK, LIGHT, PAPER, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIGNS = {"on": "o", "adjacent": "s", "both": "^", "none": "x"}


def draw_displacements(
    displacements: ArrayLike,
    relations: Sequence[str],
    *,
    centres: Mapping[str, tuple[float, float]] | None = None,
    bands: Mapping[str, tuple[float, float]] | None = None,
    unit: str = "mm",
    title: str = "",
) -> "Figure":
    """The figure, displacements of a from b.

    Parameters
    ----------
    displacements : (n, 2)
        To the right and up.
    relations : sequence of str
        The label of the pair each belongs to.
    centres : mapping of relation to (right, up), optional
        A cluster's middle, marked by a cross.
    bands : mapping of relation to (low, high), optional
        Heights between which a relation's displacements lie, shaded.
    unit : str
    title : str

    Raises
    ------
    InputError
        Displacements and relations do not correspond.
    """
    at = np.asarray(displacements, float)
    if at.shape != (len(relations), 2):
        raise InputError(f"displacements must have shape ({len(relations)}, 2), one a relation, got {at.shape}")
    palette = relation_palette(relations)
    names = [name for name in palette if name in set(relations)]
    with house_style():
        wide, high = np.ptp(at, axis=0) if len(at) else (1.0, 1.0)
        figure = new_figure(6.4, 1.3 + 4.6 * float(np.clip(high / max(wide, 1e-9), 0.35, 1.1)))
        axes = figure.subplots()
        axes.axhline(0, color=LIGHT, lw=1, zorder=0)
        axes.axvline(0, color=LIGHT, lw=1, zorder=0)
        for name, (low, high) in (bands or {}).items():
            axes.axhspan(low, high, color=mixed(palette[name], PAPER, 0.85), lw=0, zorder=-1)
        for name in names:
            _scatter(axes, at[np.array(relations) == name], name, palette[name])
        for name, centre in (centres or {}).items():
            _cross(axes, centre, palette.get(name, INK))
        axes.set(xlabel=f"to the right of b ({unit})", ylabel=f"above b ({unit})", title=title)
        axes.set_aspect("equal", adjustable="datalim")
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), handletextpad=0.2)
    return figure


def _scatter(axes: "Axes", at: np.ndarray, name: str, colour: str) -> None:
    # Many points fade, so that where they are dense stays visible.
    alpha = float(np.clip(12 / np.sqrt(max(1, len(at))), 0.25, 0.85))
    edge = {} if name == "none" else {"edgecolors": mixed(colour, INK, 0.3)}
    axes.scatter(
        *at.T, s=20, marker=_SIGNS.get(name, "D"), color=colour, alpha=alpha, linewidths=0.5,
        label=f"{name.replace('_', ' ')} ({len(at)})", zorder=1 if name == "none" else 2, **edge,
    )  # fmt: skip


def _cross(axes: "Axes", centre: tuple[float, float], colour: str) -> None:
    axes.plot(*centre, "+", ms=17, mew=5, color=PAPER, zorder=4)
    axes.plot(*centre, "+", ms=15, mew=2.2, color=mixed(colour, INK, 0.45), zorder=5)
    axes.annotate(
        f"({centre[0]:.2g}, {centre[1]:.2g})", centre, (9, -3), textcoords="offset points", fontsize=7.5,
        va="top", color=INK, zorder=5,
        bbox={"facecolor": PAPER, "alpha": 0.75, "edgecolor": GREY, "lw": 0.4, "pad": 1.5},
    )  # fmt: skip
