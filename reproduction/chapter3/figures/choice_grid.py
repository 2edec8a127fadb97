"""The grid of choices left open as a table: a row for each use of a prior, a column for each schedule and ties."""

from collections.abc import Callable, Mapping, Sequence
from itertools import product
from operator import itemgetter
from typing import Any

from lifelore.figures.heat_grid import draw_estimate_grid
from lifelore.figures.style import Axes
from reproduction.chapter3.learning.schedules import schedule_in_brief

RATIO = {"neutral": 1.0, "spread": 4.0, "ratio": True, "good": "low", "words": "{:.2f}".format}
"""Look of a table of ratios of which small ones are good."""


def place_of_default(cells: Sequence[Mapping[str, Any]], settings: Mapping[str, Any]) -> int:
    """Where the default stands among the cells of a grid."""
    default = settings["default"].items()
    return [all(cell[key] == value for key, value in default) for cell in cells].index(True)


def other_choice(cell: Mapping[str, Any], default: Mapping[str, Any], words: Mapping[str, str]) -> str | None:
    """The first choice of `words` (key → format) in which a cell differs from the default; None without any."""
    changed = (text.format(cell[key]) for key, text in words.items() if cell[key] != default[key])
    return next(changed, None)


def draw_choice_grid(
    axes: Axes,
    settings: Mapping[str, Any],
    rows: Sequence[Mapping[str, Any]],
    measure: str,
    side: Sequence[str],
    name: Callable[..., str],
    **look: Any,
) -> None:
    """Draw an estimate of every cell of the grid; the default is framed.

    `rows` are cells with ``schedule``, ``ties``, the keys of `side` and an estimate `measure`. The keys of `side`,
    of which there are two or more, make a row of the table, which ``name(*values)`` labels. `look` is that of
    `draw_estimate_grid`.
    """
    default, side_of = settings["default"], itemgetter(*side)
    columns = list(product(settings["schedules"], settings["ties"]))
    cells = {(side_of(row), tuple(row["schedule"]), row["ties"]): row[measure] for row in rows}
    sides = list(dict.fromkeys(key[0] for key in cells))
    draw_estimate_grid(
        axes,
        [[cells.get((values, tuple(schedule), ties)) for schedule, ties in columns] for values in sides],
        [name(*values) for values in sides],
        [f"{schedule_in_brief(schedule).replace(' ×', chr(10) + '×')}\n{ties}" for schedule, ties in columns],
        outlined=(sides.index(side_of(default)), columns.index((default["schedule"], default["ties"]))),
        **look,
    )
