"""Plans of a building with its people: a ward and its robot (thesis Fig 1.1), and an advised walk (Fig 3.17)."""

from collections.abc import Mapping

import numpy as np

from docs.pictures.figure_icons import draw_note, draw_person, draw_robot
from lifelore.figures.lives.floor_plan import draw_floor_plan
from lifelore.figures.style import (
    BLUE,
    GREEN,
    INK,
    ORANGE,
    PAPER,
    PURPLE,
    VERMILION,
    Axes,
    Figure,
    house_style,
    new_figure,
)  # fmt: skip

KINDS = {"patient": ORANGE, "nurse": BLUE, "doctor": PURPLE}
"""People of the ward by colour."""
_LANE = 0.22
"""How far a walk drifts from the middle of its cells, so that steps back and forth are seen; in cells."""
_ABOUT = (6.0, 4.0)
"""How much of the plan is shown about a walk, to its sides, and above and below it; in cells."""
DIRECTIONS = np.array([(0.0, -1.0), (0.0, 1.0), (1.0, 0.0), (-1.0, 0.0)])
"""x and y of north, south, east, west."""


def draw_ward(ward: Mapping) -> Figure:
    """A ward: people of three kinds, objects, the robot and its way.

    Parameters
    ----------
    ward : mapping
        ``shape``, ``cells``, ``neighbour``: the floor, see `draw_floor_plan`; ``people``: kind → (n, 2) rows and
        columns; ``objects`` (n, 2); ``way`` (n, 2), from the robot to whom it serves; ``notes``: texts;
        ``places``: for each of them (x, y) of the text and of what it is about.
    """
    with house_style():
        figure, axes = _plan(ward, (9.4, 5.9))
        way = np.asarray(ward["way"], float)
        axes.plot(way[:, 1], way[:, 0], color=VERMILION, lw=2.2, zorder=5, solid_joinstyle="round")
        rows, columns = np.asarray(ward["objects"], float).T
        axes.plot(columns, rows, "s", color=GREEN, ms=5.5, mec=PAPER, mew=0.7, zorder=6)
        for kind, places in ward["people"].items():
            for row, column in np.asarray(places, float):
                draw_person(axes, (column, row), KINDS[kind], 2.2)
        draw_robot(axes, (way[0, 1], way[0, 0]), VERMILION, 3.0)
        for (at, to), words in zip(ward["places"], ward["notes"], strict=True):
            draw_note(axes, at, to, words)
        _legend(figure, {f"{kind}s": colour for kind, colour in KINDS.items()})
    return figure


def draw_advised_walk(walk: Mapping) -> Figure:
    """An explorer's walk, the advisor's estimate along it, and the steps at which a robot advises.

    Parameters
    ----------
    walk : mapping
        The floor as of `draw_ward`; ``path`` (n, 2) rows and columns; ``p_normal`` (n,); ``advised`` (n,) bool;
        ``theta`` (4,) at the step ``shown``, one of the advised; ``goal`` (row, column).
    """
    from matplotlib.collections import LineCollection
    from matplotlib.colors import LinearSegmentedColormap

    with house_style():
        figure, axes = _plan(walk, (8.4, 6.6))
        path = np.asarray(walk["path"], float)[:, ::-1]
        path = path + np.linspace(-_LANE, _LANE, len(path))[:, None]
        shades = LinearSegmentedColormap.from_list("like the experts", [VERMILION, "#e8c9a8", BLUE])
        lines = LineCollection(
            list(np.stack([path[:-1], path[1:]], axis=1)), array=np.asarray(walk["p_normal"])[:-1], cmap=shades,
            norm="linear", linewidths=2.2, capstyle="round", zorder=5,
        )  # fmt: skip
        lines.set_clim(0, 1)
        axes.add_collection(lines)
        advised = path[np.asarray(walk["advised"])]
        axes.plot(*advised.T, "o", color=INK, ms=2.6, mew=0, zorder=6, label="a step with advice")
        row, column = walk["goal"]
        axes.plot(column, row, "*", color=GREEN, ms=20, mec=PAPER, zorder=8, label="goal, unknown to the advisor")
        x, y = path[walk["shown"]]
        draw_person(axes, (x, y), INK, 1.5)
        for share, (dx, dy) in zip(walk["theta"], DIRECTIONS, strict=True):
            if share > 0.05:
                look = {"arrowstyle": "-|>,head_width=0.35,head_length=0.5", "color": ORANGE, "lw": 1 + 3 * share}
                far, near = (x + 2.3 * dx, y + 2.3 * dy), (x + 0.9 * dx, y + 0.9 * dy)
                axes.annotate("", far, near, arrowprops=look, zorder=10)
        axes.plot([], [], color=ORANGE, lw=3, label="θ, the advice")
        draw_robot(axes, (x + 1.5, y - 1.5), VERMILION, 1.8)
        (left, top), (right, bottom) = path.min(axis=0) - _ABOUT, path.max(axis=0) + _ABOUT
        axes.set(xlim=(max(left, -0.5), right), ylim=(bottom, max(top, -0.5)))
        bar = figure.colorbar(lines, ax=axes, shrink=0.55, pad=0.01, ticks=(0, 0.5, 1))
        bar.set_label("P(M₁ | H): moves as the experts")
        bar.outline.set_visible(False)
        figure.legend(loc="outside lower center", ncols=3)
    return figure


def _plan(floor: Mapping, size: tuple[float, float]) -> tuple[Figure, Axes]:
    figure = new_figure(*size)
    axes = figure.subplots()
    draw_floor_plan(axes, floor["shape"], floor["cells"], floor["neighbour"], wall_width=1.3)
    return figure, axes


def _legend(figure: Figure, colours: Mapping[str, str]) -> None:
    from matplotlib.lines import Line2D

    def sign(mark: str, colour: str, words: str, size: float) -> Line2D:
        return Line2D([], [], marker=mark, ls="none", color=colour, ms=size, mec=PAPER, label=words)

    signs = [sign("o", colour, words, 9) for words, colour in colours.items()]
    signs += [sign("s", GREEN, "objects", 7), sign("s", VERMILION, "the robot and its way", 9)]
    figure.legend(handles=signs, loc="outside lower center", ncols=5)
