"""Support vectors and contact points as things are carried apart, a column for each cost (claim C2.11)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lifelore.core.errors import InputError
from lifelore.figures.style import BLUE, GREEN, LIGHT, ORANGE, VERMILION, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Mapping):
    return draw_parting(result["rows"], result["settings"]["lengths"], result["settings"]["costs"])


_COLOURS = (BLUE, ORANGE, GREEN, VERMILION)
_QUANTITIES = (
    ("support", "support vectors\na thing"),
    ("contacts", "contact points a thing\nany number of support vectors"),
    ("contacts_of_7", "contact points a thing\nat least 7 support vectors"),
)


def draw_parting(rows: Sequence[Mapping], lengths: Sequence[float], costs: Sequence[float]) -> "Figure":
    """Rows of support vectors, contacts and contacts of 7; a column for each cost, a line for each length.

    Parameters
    ----------
    rows : sequence of mapping
        ``{"scenes", "kernel", "gap", "unit", "support", "contacts", "contacts_of_7"}``; kernels named as
        ``60 mm, C 10``, gaps in metres, each quantity median, lower and upper quartile. Lines are of simulated
        scenes and gaps in metres; dots at the right edge of real ones.
    lengths, costs : sequence of float
        Of the kernels: metres, and per point.

    Raises
    ------
    InputError
        No row is of simulated scenes.
    """
    shown = [row for row in rows if row["unit"] in ("as seen", "metres")]
    if not any(row["scenes"] == "simulated" for row in shown):
        raise InputError("rows must hold simulated scenes, got none")
    with house_style():
        figure = new_figure(1.3 + 2.5 * len(costs), 6.6)
        grid = figure.subplots(3, len(costs), squeeze=False, sharex=True, sharey="row")
        for column, cost in enumerate(costs):
            for place, (key, label) in enumerate(_QUANTITIES):
                axes = grid[place, column]
                for colour, length in zip(_COLOURS * 3, lengths, strict=False):
                    _curve(axes, shown, f"{1000 * length:g} mm, C {cost:g}", key, f"{1000 * length:g} mm", colour)
                axes.grid(axis="y", color=LIGHT)
                if key == "support":
                    axes.set_yscale("log")
                    axes.set_title(f"C = {cost:g}" if cost < 1000 else f"C = {cost:g}, nearly hard")
                else:
                    axes.set_ylim(bottom=0)
                if column == 0:
                    axes.set_ylabel(label)
            grid[2, column].set_xlabel("gap (m)")
        handles, names = grid[0, 0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside upper center", ncols=6, title="kernel length")
    return figure


def _curve(axes: "Axes", rows: Sequence[Mapping], kernel: str, key: str, name: str, colour: str) -> None:
    for scenes, style in (("simulated", "o-"), ("real", "x")):
        mine = [row for row in rows if row["kernel"] == kernel and row["scenes"] == scenes]
        if not mine:
            continue
        gap = [row["gap"] for row in mine]
        values = np.array([row[key] for row in mine], float)
        simulated = scenes == "simulated"
        if simulated:
            axes.fill_between(gap, values[:, 1], values[:, 2], color=colour, alpha=0.14, lw=0)
        axes.plot(gap, values[:, 0], style, ms=3.2, lw=1.5, color=colour, label=name if simulated else None)
