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
    Axes,
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
_BROAD, _TALL, _UPPER, _STRIP = 0.92, 0.88, 0.64, 0.18
"""Width and height of a tile, and the heights of its upper part and of its strip."""
Tile = tuple[str, str | None, str | None]
"""Id, verdict of the first and of the second reading; None where there is none."""


def draw_verdicts(rooms: Mapping[str, Sequence[Tile]]) -> Figure:
    """Lines of tiles under the title of their room.

    The large upper part of a tile has the colour of the second reading's verdict where there is one, the thin
    strip below it that of the first reading. A claim without a result is empty.
    """
    from matplotlib.patches import Patch, Rectangle

    lines = {title: -(-len(tiles) // WIDE) for title, tiles in rooms.items()}
    height = sum(lines.values()) + 0.75 * len(rooms) + 1.3
    with house_style():
        figure = new_figure(8.2, 0.56 * height)
        axes = figure.subplots()
        if any(second for tiles in rooms.values() for *_, second in tiles):
            _draw_key(axes)
        y = 0.0
        for title, tiles in rooms.items():
            axes.text(0, y + 0.45, title, fontweight="bold", va="center")
            y += 0.7
            for place, (name, first, second) in enumerate(tiles):
                left, top = place % WIDE, y + place // WIDE
                shown = COLOURS.get(second or first or "", PAPER)
                whole = _UPPER if second else _TALL
                axes.add_patch(Rectangle((left, top), _BROAD, whole, facecolor=shown, edgecolor=LIGHT, lw=0.6))
                if second:
                    strip = (left, top + _TALL - _STRIP)
                    colour = COLOURS.get(first or "", PAPER)
                    axes.add_patch(Rectangle(strip, _BROAD, _STRIP, facecolor=colour, edgecolor=LIGHT, lw=0.6))
                axes.text(
                    left + _BROAD / 2, top + whole / 2, name, ha="center", va="center", fontsize=8,
                    fontweight="bold", color=PAPER if shown in _DARK else INK,
                )  # fmt: skip
            y += lines[title] + 0.05
        axes.set_xlim(-0.1, WIDE)
        axes.set_ylim(y + 0.1, -0.4)
        axes.set_axis_off()
        found = {verdict for tiles in rooms.values() for _, *both in tiles for verdict in both}
        shown = [Patch(facecolor=colour, label=verdict) for verdict, colour in COLOURS.items() if verdict in found]
        if any(first is None for tiles in rooms.values() for _, first, _ in tiles):
            shown.append(Patch(facecolor=PAPER, edgecolor=LIGHT, label="no result yet"))
        figure.legend(handles=shown, loc="outside lower center", ncols=len(shown), frameon=False)
    return figure


def _draw_key(axes: Axes) -> None:
    """A tile without colour, right of the first title, and what its two parts are."""
    from matplotlib.patches import Rectangle

    left, top = WIDE - 5.3, -0.32
    for y, tall in ((top, _UPPER), (top + _TALL - _STRIP, _STRIP)):
        axes.add_patch(Rectangle((left, y), _BROAD, tall, facecolor=PAPER, edgecolor=INK, lw=0.9))
    words = {
        top + _UPPER / 2: "second reading: the verdict that stands",
        top + _TALL - _STRIP / 2: "first reading",
    }
    for y, text in words.items():
        axes.text(left + _BROAD + 0.12, y, text, va="center", fontsize=8)
