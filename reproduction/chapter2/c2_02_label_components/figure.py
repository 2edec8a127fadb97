"""How often each component of a label is right and agreed on, beside its majority and the printed share."""

from collections.abc import Mapping

from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import BLUE, GREY, LIGHT, PAPER, SKY, VERMILION, house_style, new_figure
from reproduction.chapter2.scoring.method_panels import per_cent

PRINTED = {"on": (40, 28), "adjacent": (39, 18)}
"""Of 49: right, and in agreement with 75 % of the neighbours."""
BARS = {
    "right": ("right", BLUE),
    "majority": ("more frequent value", GREY),
    "agreement": ("agrees with 75 % of neighbours", SKY),
}


def draw(result: Mapping):
    names, colours = zip(*BARS.values(), strict=True)
    with house_style():
        figure = new_figure(8.2, 2.4)
        every = figure.subplots(1, len(PRINTED), squeeze=False, sharey=True)[0]
        for axes, (name, (right, agreed)) in zip(every, PRINTED.items(), strict=True):
            numbers = [per_cent(result["measured"][f"{name}_{key}"]) for key in BARS]
            title = f"component {name}"
            draw_interval_bars(
                axes, names, {name: numbers}, colours=colours, words=None, title=title, label="relationships (%)"
            )
            for place, number in enumerate(numbers):
                text = f"{number['value']:.1f}" if number else ""
                axes.text(1.5, place, text, color=PAPER, va="center", fontsize=8, fontweight="bold")
            for place, share in ((0, right), (2, agreed)):
                at = [100 * share / 49] * 2
                axes.plot(at, [place - 0.45, place + 0.45], color=VERMILION, lw=2.2, zorder=5)
            axes.set_xlim(0, 108)
            axes.grid(axis="x", color=LIGHT)
        last = every[-1]
        last.legend(
            last.lines[-1:], ["thesis, of 49"], loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.2
        )
    return figure
