"""Names and colours of agents and advisors, and the grid of mazes and experts, in the figures on advice."""

from collections.abc import Mapping, Sequence
from typing import Any

from numpy.typing import ArrayLike

from lifelore.experiments.chapter3.advice.mazes import grid_of
from lifelore.figures.heat_grid import draw_heat_grid
from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION, Axes

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
