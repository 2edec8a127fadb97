"""First episodes by family, and what each part of the agent pays, with 95 % intervals."""

from collections.abc import Mapping

from lifelore.figures.style import GREEN, INK, ORANGE, PURPLE, Axes
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

COLOURS = {"prior": ORANGE, "reuse": GREEN, "context": PURPLE}


@panels(9.0, 5.0, 2, 1, sharex=True)
def draw(result: Mapping, above: Axes, below: Axes) -> None:
    """Above: the share of the way to an agent that knows the type. Below: what each part pays in mean return."""
    readings = result["readings"]
    names = [one["cell"]["family"] for one in readings]
    shares = {"": [one["first_share"] for one in readings]}
    draw_interval_bars(
        above, names, shares, horizontal=False, words=None, label="first episode: share of\nwho knows the type"
    )
    above.axhline(0.9, color=INK, linestyle=":", linewidth=1)
    gains = {part: [one[f"{part}_gain"] for one in readings] for part in COLOURS}
    draw_interval_bars(
        below, names, gains, colours=COLOURS, horizontal=False, words=None, legend=False,
        label="mean return that a part adds\nin units of the spread",
    )  # fmt: skip
    below.axhline(0, color=INK, linewidth=1)
    below.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(COLOURS))
    for axes in (above, below):
        axes.set_axisbelow(True)
