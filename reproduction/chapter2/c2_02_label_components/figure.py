"""How often each component of a label is right, and agreed on by its neighbours, beside the printed counts."""

from collections.abc import Mapping

from lifelore.figures.style import VERMILION, Axes
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

PRINTED = {"on_right": 40, "adjacent_right": 39, "on_agreement": 28, "adjacent_agreement": 18}
"""Of 49 test relationships (§2.4.1)."""
NAMES = (
    "on right",
    "adjacent right",
    "on agrees with\n75 % of neighbours",
    "adjacent agrees with\n75 % of neighbours",
)


@panels(6.4, 2.6, grid="x")
def draw(result: Mapping, axes: Axes) -> None:
    """A bar for each share with its interval, and a line at the printed one."""
    shares = [result["measured"][name] for name in PRINTED]
    draw_interval_bars(axes, NAMES, {"here": shares}, scale=100, words=None, label="test relationships (%)")
    for place, printed in enumerate(PRINTED.values()):
        axes.plot([100 * printed / 49] * 2, [place - 0.4, place + 0.4], color=VERMILION, lw=2.4,
                  label="thesis, of 49" * (not place))  # fmt: skip
    axes.set_xlim(0, 100)
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
