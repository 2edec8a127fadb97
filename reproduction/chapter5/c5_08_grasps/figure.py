"""Objects grasped within a number of tries, by search; scenes with their contact networks above."""

from collections.abc import Mapping

from reproduction.chapter2.scenes.scene_example import examples_of
from reproduction.chapter5.c5_08_grasps.run import SEARCHES, TRANSFERS
from reproduction.figures.gallery import gallery_above
from reproduction.figures.palettes import METHOD_COLOURS

NAMES = {
    "seeded": "from seeds",
    "anywhere": "unseeded, anywhere",
    "above": "unseeded, middle from above",
    "carried": "carried by contact points",
    "not carried": "not carried, anywhere",
    "above, not carried": "not carried, middle from above",
}


def draw(result: Mapping):
    curves = {row["search"]: row["within"] for row in result["rows"] if "search" in row}
    figure, below = gallery_above(examples_of(result), 3.2, layers=("cloud", "networks"))
    panels = below.subplots(1, 2, sharey=True)
    titles = ("objects with a seed", "objects to which a grasp could be carried")
    for axes, names, title in zip(panels, (SEARCHES, TRANSFERS), titles, strict=True):
        for name, colour in zip(names, METHOD_COLOURS, strict=False):
            if name in curves:
                tries = range(1, len(curves[name]) + 1)
                axes.plot(tries, curves[name], "o-", ms=3.5, color=colour, label=NAMES[name])
        axes.set(ylim=(0, 1), xlabel="tries", title=title)
        axes.grid(axis="y")
        if curves:
            axes.legend(loc="upper left", fontsize=7.5)
    panels[0].set_ylabel("share grasped")
    return figure
