"""Loss by speed for three sizes of the ball (Figure 4.15)."""

from collections.abc import Mapping

from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS
from lifelore.figures.style import Axes
from reproduction.chapter4.ball_game.looks import size_lines
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

SHOWN = (2, 20, 60)
"""The thesis shows three representative sizes and does not name them."""


@panels(8.4, 2.9, 1, len(SHOWN))
def draw(result: Mapping, *every: Axes) -> None:
    """A panel for each size, as their losses differ tenfold; a ring at the best speed."""
    row = result["rows"][0]
    for axes, size in zip(every, SHOWN, strict=True):
        look = size_lines([size], marker="o", markersize=4)
        mean, error = (row[key][SIZES.index(size)] for key in ("loss", "error"))
        draw_curves(axes, SPEEDS, {f"b = {size}": {"mean": mean, "deviation": error}}, looks=look, legend=False)
        best = min(range(len(mean)), key=mean.__getitem__)
        axes.plot(SPEEDS[best], mean[best], "o", ms=10, mfc="none", mec=look[f"b = {size}"]["color"], mew=1.5)
        axes.set(title=f"b = {size}", xlabel="speed z", xticks=SPEEDS, ylim=(0, None))
    every[0].set_ylabel("mean loss, band 95 %")
