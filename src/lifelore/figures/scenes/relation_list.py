"""A scene's relations as a list beside its picture, in the picture's own signs."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lifelore.core.labelled_cloud import TABLE
from lifelore.figures.scenes.object_palette import mixed
from lifelore.figures.scenes.scene_document import TABLE_NAME, Bond
from lifelore.figures.scenes.scene_marks import draw_arrow, draw_label, label_size
from lifelore.figures.style import GREY, INK, PAPER

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ROW, _CHIP, _GLYPH = 17.0, 9.0, 50.0
"""Height of a row, centre of the first chip, length of the sign: points."""


def draw_relation_list(
    axes: "Axes", bonds: Sequence[Bond], palette: Mapping[int, str], size: tuple[float, float], heading: str
) -> None:
    """The list, then what the table carries, then what the marks mean.

    Parameters
    ----------
    axes : matplotlib axes
    bonds : sequence of Bond
    palette : mapping of int to str
    size : (width, height)
        Of the axes, points.
    heading : str
    """
    width, height = size
    axes.set(xlim=(0, width), ylim=(height, 0))
    axes.set_axis_off()
    axes.text(0, 6, heading, fontweight="bold", fontsize=10, va="center_baseline")
    between = [bond for bond in bonds if not bond.with_table]
    table = [bond for bond in bonds if bond.with_table]
    table_rows = _table_lines(table, width)
    free = height - 34 - 46 - (18 + _ROW * len(table_rows) if table else 0)
    row = max(11.0, min(_ROW, free / max(1, len(between))))
    shown = sorted(sorted(between, key=lambda b: -b.confidence)[: max(0, int(free / row))], key=between.index)
    y = 24.0
    for text, x, side in (("confidence", width - 34, "right"), ("gap", width, "right")):
        if shown:
            axes.text(x, y, text, fontsize=7, color=GREY, ha=side, va="center_baseline")
    for bond in shown:
        y += row
        _row(axes, bond, y, width, palette, small=row < 14)
    if not between:
        y += row
        axes.text(0, y, "no relations between objects", color=GREY, va="center_baseline")
    if len(shown) < len(between):
        y += row
        axes.text(
            0, y, f"and {len(between) - len(shown)} less sure", color=GREY, fontsize=7.5, va="center_baseline"
        )
    if table:
        _table(axes, table_rows, y + 24, palette)
    _key(axes, height, width)


def _row(axes: "Axes", bond: Bond, y: float, width: float, palette: Mapping[int, str], *, small: bool) -> None:
    left, right = _CHIP, _CHIP + _GLYPH
    size = 7.0 if small else 8.0
    draw_arrow(axes, (left, y), (right, y), bond, shrink=size + 1.5)
    for x, number in ((left, bond.a), (right, bond.b)):
        draw_label(axes, (x, y), str(number), palette.get(number, GREY), size=size)
    axes.text(right + 16, y, bond.relation.replace("_", " "), fontsize=9, va="center_baseline")
    axes.text(width - 34, y, f"{100 * bond.confidence:.0f} %", fontsize=8, va="center_baseline", ha="right")
    if bond.gap is not None and bond.gap < float("inf"):
        axes.text(width, y, f"{1000 * bond.gap:.0f} mm", fontsize=8, va="center_baseline", ha="right")


def _table_lines(bonds: Sequence[Bond], width: float) -> list[list[Bond]]:
    """The chips of the objects on the table, broken into lines that fit."""
    lines: list[list[Bond]] = []
    room = 0.0
    for bond in bonds:
        need = label_size(_named(bond), 8)[0] + 4
        if not lines or room < need:
            lines.append([])
            room = width
        lines[-1].append(bond)
        room -= need
    return lines


def _named(bond: Bond) -> str:
    """The object's number; a relation other than *on* beside it."""
    number = str(bond.a if bond.b == TABLE else bond.b)
    return number if bond.relation == "on" and bond.b == TABLE else f"{number} {bond.relation}"


def _table(axes: "Axes", lines: list[list[Bond]], y: float, palette: Mapping[int, str]) -> None:
    axes.text(0, y, f"on the {TABLE_NAME}", fontsize=9, va="center_baseline")
    for line in lines:
        y += _ROW
        x = 0.0
        for bond in line:
            text = _named(bond)
            wide = label_size(text, 8)[0]
            number = bond.a if bond.b == TABLE else bond.b
            colour = mixed(palette.get(number, GREY), PAPER, 0.65 * (1 - bond.confidence))
            draw_label(axes, (x + wide / 2 + 1, y), text, colour, size=8)
            x += wide + 4


def _key(axes: "Axes", height: float, width: float) -> None:
    """What circles, lines and dashes are."""
    colour = mixed(GREY, INK, 0.3)
    for place, text in enumerate(("contact point", "network of an object", "contact of two objects")):
        y = height - 30 + 12 * place
        if place == 0:
            axes.plot([9], [y], "o", ms=6, mfc="none", mec=colour, mew=1.4)
        else:
            dashes = "-" if place == 1 else (0, (2.2, 1.4))
            axes.plot([1, 17], [y, y], color=colour, lw=2.4 if place == 1 else 1.1, linestyle=dashes)
        axes.text(24, y, text, fontsize=7.5, color=GREY, va="center_baseline")
