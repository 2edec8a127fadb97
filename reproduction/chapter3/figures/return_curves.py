"""Learning curves by episode with a standard deviation, and below them bars of the episodes to 80 % of optimal."""

from collections.abc import Mapping

from lifelore.figures.style import GREY, Figure, colour_of, new_figure
from reproduction.figures.curves import draw_curves
from reproduction.figures.interval_bars import draw_interval_bars


def draw_return_curves(result: Mapping, methods: Mapping[str, tuple[str, str]]) -> Figure:
    """The figure of a result with rows ``curve_of`` and measures ``to_80_NAME`` and ``optimal_return``.

    `methods` gives by name the label and the name of the colour, in the order of drawing.
    """
    measured = result["measured"]
    colours = {label: colour_of(style) for label, style in methods.values()}
    curves = {methods[row["curve_of"]][0]: row for row in result["rows"]}
    figure = new_figure(6.4, 4.6)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(1, 0.13 * len(methods)))
    draw_curves(
        above, None, {label: curves[label] for label in colours},
        looks={label: {"color": colour, "linewidth": 1.5} for label, colour in colours.items()},
        ylabel="return of an episode", level=(measured["optimal_return"]["value"], "optimal"), legend=False,
    )  # fmt: skip
    above.axhline(0, color=GREY, linewidth=0.6, zorder=0)
    above.legend(loc="lower right")
    draw_interval_bars(
        below, list(colours), {"": [measured[f"to_80_{name}"] for name in methods]},
        colours=list(colours.values()), words="{:.0f}".format,
        label="episode; bars: episodes to 80 % of optimal return",
    )  # fmt: skip
    below.set_xlim(0, result["settings"]["episodes"])
    return figure
