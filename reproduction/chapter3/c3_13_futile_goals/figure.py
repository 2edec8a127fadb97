"""Figure of claim C3.13: Eq. 3.6 against measured frequencies, and how near worlds as found come to it."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.style import BLUE, GREEN, INK, ORANGE, Axes
from reproduction.figures.panels import panels

NO_TASK = 0.35
"""Place of "no task" on the logarithmic axis."""


@panels(8.6, 3.6, 1, 2, grid="")
def draw(result: Mapping, constructed: Axes, found: Axes) -> None:
    """Constructed worlds, then worlds as found."""
    _draw_constructed(constructed, [row for row in result["rows"] if "formula" in row])
    constructed.set_title(f"Worst case, {result['settings']['actions'][0]} actions")
    _draw_found(found, [row for row in result["rows"] if "kind" in row])


def _draw_constructed(axes: Axes, rows: list[Mapping]) -> None:
    """The formula as a line and measured frequencies as points, for each α⁰."""
    for colour, alpha0 in zip((BLUE, ORANGE, GREEN), sorted({row["alpha0"] for row in rows}), strict=False):
        cases = [row for row in rows if row["alpha0"] == alpha0]
        x = [case["tasks"] or NO_TASK for case in cases]
        axes.plot(x, [case["formula"] for case in cases], color=colour, lw=1.3, label=f"Eq. 3.6, α⁰ = {alpha0:g}")
        measured, low, high = (np.array([case[name] for case in cases]) for name in ("measured", "low", "high"))
        axes.errorbar(x, measured, [measured - low, high - measured], fmt="o", ms=4, color=colour, lw=1)
    ticks = sorted({row["tasks"] for row in rows})
    axes.set(xscale="log", yscale="log", xlabel="tasks so far", ylabel="probability of the one action")
    axes.set_xticks([tick or NO_TASK for tick in ticks], [str(tick) if tick else "none" for tick in ticks])
    axes.minorticks_off()
    axes.grid()
    axes.legend()


def _draw_found(axes: Axes, worlds: list[Mapping]) -> None:
    """A point for each world: its least probable way into a futile goal, over the bound."""
    for place, row in enumerate(worlds):
        places = place + np.linspace(-0.25, 0.25, len(row["least"]))
        axes.plot(row["least"], places, "o", ms=2.6, alpha=0.6, color=BLUE, mew=0)
    axes.axvline(1.0, color=INK, lw=1.1, ls=(0, (4, 3)))
    axes.set(xscale="log", xlabel="least probability of a world, over Eq. 3.6", title="Worlds as found")
    names = [f"{row['kind']}, {row['of_tasks']} task{'s' * (row['of_tasks'] > 1)}" for row in worlds]
    axes.set_yticks(range(len(worlds)), names)
    axes.invert_yaxis()
    axes.tick_params(axis="y", length=0)
