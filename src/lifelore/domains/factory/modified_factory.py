"""The modified factory: a new layout for every task.

Three by three zones of 6×6 cells behind an outer wall; walls between every two zones, some of them with a gap;
short walls inside the zones; two zones with procurement points and two with assembly points, all connected.

The thesis lets each chosen zone have "either four or five" points, so 8 to 10 of either kind, and assembles up to
9 components, without saying what becomes of a surplus or a lack. Here one zone of a pair has four and the other
five, drawn which, so there is one point of either kind for each of 9 components. Nor does it say how wide a gap
is (here one cell), how many walls have one (8, which join all zones, to 11 of the 12), how many inner walls there
are (2 to 4 a zone, 2 to 4 cells long, which may touch) or where episodes start (one free cell that is no point).
Express routes are not mentioned: there are none. Thesis: §3.4.4, Figure 3.10.
"""

from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from lifelore.domains.factory.factory import N_COMPONENTS, Factory
from lifelore.domains.factory.layout import DISCOUNT
from lifelore.domains.grids.grid_world import GridWorld

ZONES, ZONE_SIDE = 3, 6
SIDE = ZONES * ZONE_SIDE + ZONES + 1
"""Cells a side, the walls counted: 22."""
INNER_WALLS, INNER_LENGTH = (2, 4), (2, 4)
"""Inner walls a zone, and their lengths in cells: the least and the most."""
_TRIALS = 50


def modified_factory(generator: np.random.Generator, discount: float = DISCOUNT) -> Factory:
    """A random layout.

    Parameters
    ----------
    generator : numpy.random.Generator
    discount : float
        γ in [0, 1).

    Examples
    --------
    >>> one = modified_factory(np.random.default_rng(0))
    >>> one.floor.shape, one.n_components
    ((22, 22), 9)
    """
    free = _walled_zones()
    _open_gaps(free, generator)
    for zone in np.ndindex(ZONES, ZONES):
        _put_inner_walls(free, zone, generator)
    floor = GridWorld.from_free("modified factory", free, discount=discount)
    chosen = generator.permutation(ZONES * ZONES)[:4]
    zone_of = _zone_of(floor.cells)
    procure_at, assemble_at = (_draw_points(zone_of, pair, generator) for pair in (chosen[:2], chosen[2:]))
    others = np.setdiff1d(np.flatnonzero(zone_of >= 0), np.concatenate([procure_at, assemble_at]))
    return Factory(
        floor,
        procure_at,
        assemble_at,
        np.zeros(floor.n_states, np.bool_),
        int(generator.choice(others)),
        np.isin(zone_of, chosen[:2]),
        np.isin(zone_of, chosen[2:]),
    )


def _walled_zones() -> NDArray[np.bool_]:
    inside = np.arange(SIDE) % (ZONE_SIDE + 1) > 0
    return np.logical_and.outer(inside, inside)


def _open_gaps(free: NDArray[np.bool_], generator: np.random.Generator) -> None:
    """One cell of some walls between zones, first those that join all zones; at least one wall stays whole."""
    walls = [(row, column, 0) for row, column in product(range(ZONES - 1), range(ZONES))]
    walls += [(row, column, 1) for row, column in product(range(ZONES), range(ZONES - 1))]
    order = [walls[i] for i in generator.permutation(len(walls))]
    joining, others = [], []
    group = np.arange(ZONES * ZONES).reshape(ZONES, ZONES)
    for wall in order:
        row, column, across = wall
        here, there = group[row, column], group[row + (not across), column + across]
        (joining if here != there else others).append(wall)
        group[group == there] = here
    n_gaps = generator.integers(len(joining), len(walls))
    for row, column, across in (joining + others)[:n_gaps]:
        at = [row * (ZONE_SIDE + 1) + 1, column * (ZONE_SIDE + 1) + 1]
        at[across] += ZONE_SIDE
        at[1 - across] += int(generator.integers(ZONE_SIDE))
        free[tuple(at)] = True


def _put_inner_walls(free: NDArray[np.bool_], zone: tuple[int, ...], generator: np.random.Generator) -> None:
    """Short straight walls that part nothing from the rest; fewer where no more have room; in place."""
    wanted = int(generator.integers(INNER_WALLS[0], INNER_WALLS[1] + 1))
    for _ in range(_TRIALS):
        if not wanted:
            return
        cells = _draw_segment(zone, generator)
        if free[cells].all():
            free[cells] = False
            if ndimage.label(free)[1] == 1:  # type: ignore[index]
                wanted -= 1
            else:
                free[cells] = True


def _draw_segment(zone: tuple[int, ...], generator: np.random.Generator) -> tuple[NDArray, NDArray]:
    """Rows and columns of a straight wall that lies inside a zone."""
    length = int(generator.integers(INNER_LENGTH[0], INNER_LENGTH[1] + 1))
    along, beside = int(generator.integers(ZONE_SIDE - length + 1)), int(generator.integers(ZONE_SIDE))
    place = [np.full(length, beside), along + np.arange(length)]
    if generator.random() < 0.5:
        place.reverse()
    return tuple(np.asarray(zone)[:, None] * (ZONE_SIDE + 1) + 1 + np.array(place))  # type: ignore[return-value]


def _zone_of(cells: NDArray[np.int32]) -> NDArray[np.int64]:
    """(n_cells,) number of the zone that a cell lies in, row by row; -1 in a gap."""
    zone, place = cells // (ZONE_SIDE + 1), cells % (ZONE_SIDE + 1)
    return np.where((place > 0).all(axis=1), zone @ np.array([ZONES, 1]), -1)


def _draw_points(
    zone_of: NDArray[np.int64], pair: NDArray[np.int64], generator: np.random.Generator
) -> NDArray[np.int32]:
    """A point for each component: four in one zone of the pair, five in the other, dealt at random."""
    share = (N_COMPONENTS // 2, N_COMPONENTS - N_COMPONENTS // 2)
    drawn = [
        generator.choice(np.flatnonzero(zone_of == zone), size=n, replace=False)
        for zone, n in zip(generator.permutation(pair), share, strict=True)
    ]
    return generator.permutation(np.concatenate(drawn)).astype(np.int32)
