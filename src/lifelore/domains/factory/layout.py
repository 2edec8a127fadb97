"""The factory of Figure 3.6, from a drawing.

The thesis gives the figure and no numbers; this layout has what its text names: walls, a region of nine
procurement points and one of nine assembly points apart from it, express routes between them, one start.
Thesis: §3.4.2.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.domains.factory.factory import Factory
from lifelore.domains.grids.grid_world import GridWorld

DISCOUNT = 0.99
WALL, EXPRESS, START = "#", "+", "S"
PROCURE_SIGNS, ASSEMBLE_SIGNS = "123456789", "abcdefghi"

PLAN = """
####################
#.........#........#
#.1..2..3.+++++++..#
#.........#.....+..#
#.4..5..6.#.###.+..#
#.........#.#...+..#
#.7..8..9.#.#...+..#
#.........#.###.+..#
#####+#####.....+..#
#....+..........+..#
#S+++++++++++++++..#
#....+....#.....+..#
#.##.+.##.######+###
#.#..+..#.#.....+..#
#.#..+..#.#.a..b..c#
#.##.+.##.#........#
#....+....#.d..e..f#
#....+....#........#
#....++++++.g..h..i#
####################
"""
"""Signs: # wall, + express route, S start (on a route), 1-9 procurement, a-i assembly of the same component."""


def factory(plan: str = PLAN, discount: float = DISCOUNT, name: str = "factory") -> Factory:
    """The thesis's factory, or another from a drawing in the signs of `PLAN`.

    Raises
    ------
    InputError
        The rows differ in length, or the start or one of a pair of points is missing or doubled.

    Examples
    --------
    >>> factory().n_cells, factory().task([0, 4]).domain.n_states
    (275, 2475)
    """
    picture = _signs(plan)
    floor = GridWorld.from_free(name, picture != WALL, discount=discount)
    at = picture[tuple(floor.cells.T)]
    procure_at, assemble_at = _points(at, PROCURE_SIGNS), _points(at, ASSEMBLE_SIGNS)
    start = np.flatnonzero(at == START)
    if len(start) != 1:
        raise InputError(f"plan must have one start '{START}', got {len(start)}")
    return Factory(
        floor,
        procure_at,
        assemble_at,
        (at == EXPRESS) | (at == START),
        int(start[0]),
        _rectangle_around(floor.cells, procure_at),
        _rectangle_around(floor.cells, assemble_at),
    )


def _signs(plan: str) -> NDArray[np.str_]:
    rows = plan.split()
    lengths = sorted({len(row) for row in rows})
    if len(lengths) != 1:
        raise InputError(f"plan must have rows of one length, got lengths {lengths}")
    return np.array([list(row) for row in rows])


def _points(at: NDArray[np.str_], signs: str) -> NDArray[np.int32]:
    """The cells of the points in the order of their signs; as many as are drawn, without gaps."""
    drawn = [sign for sign in signs if sign in at]
    if not drawn or "".join(drawn) != signs[: len(drawn)] or any((at == sign).sum() > 1 for sign in drawn):
        raise InputError(f"plan must show each of '{signs}' once, from the first on, got '{''.join(drawn)}'")
    return np.array([int(np.flatnonzero(at == sign)[0]) for sign in drawn], np.int32)


def _rectangle_around(cells: NDArray[np.int32], points: NDArray[np.int32]) -> NDArray[np.bool_]:
    low, high = cells[points].min(axis=0), cells[points].max(axis=0)
    return ((cells >= low) & (cells <= high)).all(axis=1)
