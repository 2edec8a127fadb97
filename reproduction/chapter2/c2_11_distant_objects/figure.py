"""Support vectors, and pairs with a contact point, of objects moved apart (§2.4.1)."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREEN, ORANGE, VERMILION, Axes
from reproduction.chapter2.c2_11_distant_objects.run import DEFAULT
from reproduction.figures.panels import panels

COLOURS = (BLUE, ORANGE, GREEN, VERMILION)


@panels(8.4, 3.2, 1, 2, sharex=True)
def draw(result: Mapping, left: Axes, right: Axes) -> None:
    """A line for each length of the kernel at the default cost, ours in bold."""
    lines = sorted((row for row in result["rows"] if row["cost"] == DEFAULT[1]), key=lambda row: row["length"])
    for number, row in enumerate(lines):
        look = {
            "color": COLOURS[number % len(COLOURS)], "marker": "o", "markersize": 3.2,
            "lw": 2.4 if row["length"] == DEFAULT[0] else 1.3, "label": f"{1000 * row['length']:g} mm",
        }  # fmt: skip
        left.plot(row["gap"], row["support"], **look)
        right.plot(row["gap"], [100 * share for share in row["with_contact"]], **look)
    left.set(ylabel="support vectors an object (median)", xlabel="gap (m)")
    right.set(ylabel="pairs with a contact point (%)", xlabel="gap (m)")
    left.set_ylim(bottom=0)
    right.set_ylim(-2, 102)
    right.legend(title="length of the kernel", title_fontsize=8)
