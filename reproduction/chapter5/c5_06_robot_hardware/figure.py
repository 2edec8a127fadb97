"""Power of a trial on a robot by its number of tasks; and the numbers that decide, where a trial has them."""

from collections.abc import Mapping

from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import BLUE, INK, LIGHT, SKY, house_style, new_figure

DECIDING = {
    "points_less_scratch": "points, less scratch",
    "points_less_no_perception": "points, less no perception",
    "points_less_no_prior": "points, less no prior",
    "spills_less_scratch": "spills, less scratch",
    "brought": "targets brought, share",
}


def draw(result: Mapping):
    measured = {name: result["measured"][name] for name in DECIDING}
    known = measured["brought"]["value"] is not None
    with house_style():
        figure = new_figure(9.2, 3.4)
        left, right = figure.subplots(1, 2, gridspec_kw={"width_ratios": [1.1, 1]})
        powers = [row for row in result["rows"] if "power" in row]
        for row, colour in zip(powers, (SKY, BLUE, INK), strict=False):
            label = f"{row['effect']:g} standard deviations"
            left.plot(row["tasks"], row["power"], "o-", ms=3.5, color=colour, label=label)
        left.set(xlabel="tasks, each with every agent", ylabel="power", ylim=(0, 1.02), title="length of a trial")
        left.grid(axis="y", color=LIGHT)
        left.legend(loc="lower right", title="true difference", fontsize=7.5)
        if known:
            numbers = {"robot": [measured[name] for name in DECIDING]}
            draw_interval_bars(right, list(DECIDING.values()), numbers, title="measured on a robot")
        else:
            right.set_axis_off()
            right.set_title("measured on a robot")
            conditions = "\n".join(f"– {words}: not measured" for words in DECIDING.values())
            right.text(0, 0.92, conditions, va="top", transform=right.transAxes, fontsize=9, linespacing=1.8)
    return figure
