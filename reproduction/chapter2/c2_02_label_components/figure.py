"""How often each component of a label is right, and agreed on by its neighbours, beside the printed counts."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, VERMILION, Axes
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
    for place, (name, printed) in enumerate(PRINTED.items()):
        number = result["measured"][name]
        low, high = number["ci95"] or [number["value"]] * 2
        ends = [[100 * (number["value"] - low)], [100 * (high - number["value"])]]
        axes.barh(
            place, 100 * number["value"], 0.6, xerr=ends, color=BLUE, ecolor="black", label="here" * (not place)
        )
        axes.plot([100 * printed / 49] * 2, [place - 0.4, place + 0.4], color=VERMILION, lw=2.4,
                  label="thesis, of 49" * (not place))  # fmt: skip
    axes.set_yticks(range(len(NAMES)), NAMES)
    axes.invert_yaxis()
    axes.set(xlim=(0, 100), xlabel="test relationships (%)")
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
