"""All claims at a glance: a tile for each, in the colours of its two verdicts."""

from collections.abc import Mapping, Sequence

from lifelore.figures.style import (
    BLUE,
    GREY,
    INK,
    LIGHT,
    PAPER,
    SKY,
    VERMILION,
    Figure,
    house_style,
    new_figure,
)

WIDE = 13
"""Tiles of a line."""
COLOURS = {
    "holds": BLUE, "holds in part": SKY, "undecided": GREY, "does not hold": VERMILION, "cannot be tested": LIGHT,
}  # fmt: skip
_DARK = (BLUE, VERMILION, GREY)
Tile = tuple[str, str | None, str | None]
"""Id, verdict of the first and of the second reading; None where there is none."""


def draw_verdicts(rooms: Mapping[str, Sequence[Tile]]) -> Figure:
    """Lines of tiles under the title of their room.

    The upper half of a tile has the colour of the second reading's verdict where there is one, the rest that of
    the first reading. A claim without a result is empty.
    """
    from matplotlib.patches import Patch, Rectangle

    lines = {title: -(-len(tiles) // WIDE) for title, tiles in rooms.items()}
    height = sum(lines.values()) + 0.75 * len(rooms) + 0.9
    with house_style():
        figure = new_figure(8.2, 0.56 * height)
        axes = figure.subplots()
        y = 0.0
        for title, tiles in rooms.items():
            axes.text(0, y + 0.45, title, fontweight="bold", va="center")
            y += 0.7
            for place, (name, first, second) in enumerate(tiles):
                left, top = place % WIDE, y + place // WIDE
                axes.add_patch(
                    Rectangle((left, top), 0.92, 0.88, facecolor=COLOURS.get(first or "", PAPER), edgecolor=LIGHT)
                )
                if second:
                    axes.add_patch(Rectangle((left, top), 0.92, 0.44, facecolor=COLOURS[second], edgecolor="none"))
                    axes.plot([left, left + 0.92], [top + 0.44] * 2, color=PAPER, linewidth=1.2)
                words = INK if COLOURS.get(second or first or "", PAPER) not in _DARK else PAPER
                axes.text(
                    left + 0.46, top + (0.22 if second else 0.44), name, ha="center", va="center", fontsize=7.5,
                    color=words,
                )  # fmt: skip
            y += lines[title] + 0.05
        axes.set_xlim(-0.1, WIDE)
        axes.set_ylim(y + 0.1, -0.1)
        axes.set_axis_off()
        found = {verdict for tiles in rooms.values() for _, *both in tiles for verdict in both}
        shown = [Patch(facecolor=colour, label=verdict) for verdict, colour in COLOURS.items() if verdict in found]
        if any(first is None for tiles in rooms.values() for _, first, _ in tiles):
            shown.append(Patch(facecolor=PAPER, edgecolor=LIGHT, label="no result yet"))
        figure.legend(handles=shown, loc="outside lower center", ncols=len(shown), frameon=False)
    return figure
