"""An L-block and a ball with their networks (Figure 2.1), and what contact points and centres of mass tell."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, ORANGE, Figure
from reproduction.chapter2.c2_13_contacts_and_centres.run import ON_BLOCK, ON_POST
from reproduction.chapter2.scenes.scene_example import examples_of
from reproduction.figures.gallery import gallery_above
from reproduction.figures.interval_bars import draw_interval_bars

NAMES = {ON_BLOCK: "ball on the block", ON_POST: "ball on a post, centres as far apart"}
COLOURS = {"contacts": BLUE, "centres": ORANGE}


def draw(result: Mapping) -> Figure:
    """The networks above, with every contact and with strong ones; bars below."""
    figure, below = gallery_above(examples_of(result), 2.0, columns=2, layers=("cloud", "networks"))
    told = {(row["told by"], row["arrangement"]): row for row in result["rows"] if "told by" in row}
    bars = {name: [told[name, at] for at in NAMES] for name in COLOURS}
    axes = below.subplots()
    draw_interval_bars(
        axes, list(NAMES.values()), bars, colours=COLOURS, scale=100, words="{:.0f}".format,
        label="classified right (%)",
    )  # fmt: skip
    axes.set(xlim=(0, 112), xticks=range(0, 101, 20))
    axes.grid(axis="x")
    return figure
