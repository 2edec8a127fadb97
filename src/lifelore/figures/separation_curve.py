"""Support vectors and contact points of two objects as they are moved apart (claim C2.11, thesis §2.4.1)."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lifelore.core.errors import InputError
from lifelore.figures.object_palette import method_palette
from lifelore.figures.style import GREY, LIGHT, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_QUANTITIES = (("support_vectors", "support vectors"), ("nodes", "contact points"))


def draw_separation(curves: Mapping[str, Mapping], *, near: float | None = None) -> "Figure":
    """Support vectors above, contact points below, against the gap between the objects.

    Parameters
    ----------
    curves : mapping
        By name of the setting: ``{"gap", "support_vectors", "nodes"}``, gaps in metres, each quantity either
        ``(n,)`` or ``(n, 3)``: median, low, high.
    near : float, optional
        Metres up to which a pair counts as near, marked.

    Raises
    ------
    InputError
        A quantity does not correspond to the gaps.
    """
    palette = method_palette(curves)
    with house_style():
        figure = new_figure(6.4, 4.4)
        panels = figure.subplots(2, 1, sharex=True)
        for axes, (key, label) in zip(panels, _QUANTITIES, strict=True):
            for name, curve in curves.items():
                gap, values = 1000 * np.asarray(curve["gap"], float), np.asarray(curve[key], float)
                if len(values) != len(gap):
                    raise InputError(f"{key} of '{name}' must have one row a gap ({len(gap)}), got {len(values)}")
                middle = values if values.ndim == 1 else values[:, 0]
                if values.ndim == 2:
                    axes.fill_between(gap, values[:, 1], values[:, 2], color=palette[name], alpha=0.15, lw=0)
                axes.plot(gap, middle, "o-", ms=3.2, lw=1.7, color=palette[name], label=name)
            axes.set(ylabel=label)
            axes.set_ylim(bottom=0)
            axes.grid(axis="y", color=LIGHT)
            if near is not None:
                axes.axvline(1000 * near, color=GREY, lw=1, ls=(0, (4, 3)))
        if near is not None:
            panels[0].annotate(
                "near", (1000 * near, 1), (-3, -2), xycoords=("data", "axes fraction"),
                textcoords="offset points", ha="right", va="top", fontsize=7.5, color=GREY,
            )  # fmt: skip
        panels[1].set_xlabel("gap between the objects (mm)")
        if len(curves) > 1:
            panels[0].legend()
    return figure
