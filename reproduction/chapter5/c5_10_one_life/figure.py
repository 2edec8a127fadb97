"""First episodes by family, and what each part of the agent pays, with 95 % intervals."""

from collections.abc import Mapping

from lifelore.figures.style import GREEN, INK, LIGHT, ORANGE, PURPLE, Figure, house_style, new_figure
from reproduction.figures.interval_bars import draw_interval_bars

COLOURS = {"prior": ORANGE, "reuse": GREEN, "context": PURPLE}


@house_style()
def draw(result: Mapping) -> Figure:
    """Above: the share of the way to an agent that knows the type. Below: what each part pays in mean return."""
    figure = new_figure(9.0, 5.0)
    above, below = figure.subplots(2, 1, sharex=True)
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
        axes.grid(axis="y", color=LIGHT)
        axes.set_axisbelow(True)
    return figure
