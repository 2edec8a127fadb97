"""Names and colours of agents and advisors, and the grid of mazes and experts, in the figures on advice."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION, Axes
from reproduction.chapter3.advice.buildings import other_choices
from reproduction.chapter3.advice.mazes import grid_of

EXPLORERS = {
    "random": "random motion",
    "avoid": "random, avoiding obstacles",
    "left": "always left",
    "bug": "goal-seeking bug",
}
AGENTS = {**EXPLORERS, "q-learning": "Q-learning", "optimal": "optimal"}
AGENT_COLOURS = dict(zip(AGENTS, (VERMILION, ORANGE, GREEN, PURPLE, BLUE, INK), strict=True))
ADVISORS = {
    "none": "no advice",
    "thesis": "the thesis's advisor",
    "better": "better advisor",
    "uniform only": "better advisor, Uniform its only other model",
}
ADVISOR_COLOURS = {"none": GREY, "thesis": VERMILION, "better": BLUE, "uniform only": SKY}
EXPERTS_IN_WORDS = (
    "Experts: “walks” to each goal from anywhere; “few” such walks; “trips”, walks that start at other goals; "
    "“policies”, the best actions of every state."
)


def draw_maze_grid(
    axes: Axes,
    result: Mapping,
    values: ArrayLike,
    certain: ArrayLike,
    sides: Sequence[str],
    *,
    title: str,
    framed_row: int | None = None,
    **look: Any,
) -> None:
    """Draw a heat grid with a column for each loop density and kind of experts, the default column framed.

    `values` and `certain` are (n_sides, n_columns), columns in the order of `grid_of`; with `framed_row` only the
    cell of that row is framed.
    """
    columns, default = grid_of(result["settings"]), result["settings"]["default"]
    heads = [f"{'few' if experts == 'few walks' else experts}\n{loops:g}" for loops, experts in columns]
    framed = framed_row, columns.index((default["loops"], default["experts"]))
    draw_heat_grid(axes, values, certain, sides, heads, outlined=framed, **look)
    axes.set(title=title, xlabel="experts, and share of walls opened into loops")


def draw_buildings(
    axes: Axes,
    settings: Mapping,
    pairs: Sequence[Sequence[tuple[float, float]]],
    sides: Sequence[str],
    **look: Any,
) -> None:
    """Draw numbers without and with advice in every building, and with other α⁰ in the advice.

    `pairs` are (n_sides, n_choices), choices in the order of the default and `other_choices`; a cell is shaded by
    its gain.
    """
    named = [building["name"] for building in settings["buildings"]]
    heads = [
        f"{named[place]}\nα⁰ {alpha0:g}" if alpha0 else _in_brief(settings["buildings"][place])
        for place, alpha0 in [(0, 0.0), *other_choices(settings)]
    ]
    gains = np.array(pairs)[..., 1] - np.array(pairs)[..., 0]
    words = iter(f"{alone:.0f} → {advised:.0f}" for row in pairs for alone, advised in row)
    draw_heat_grid(axes, gains, np.zeros(gains.shape, bool), sides, heads, words=lambda _: next(words), **look)


def _in_brief(building: Mapping) -> str:
    return f"{building['name']}\n{building['size']}², loops {building['loops']:g}"
