"""Exports experience for nav2: masks for its costmap filters, and the prior as vectors.

Both masks have the grid of the user's map and the mode ``raw``: a pixel's value is the occupancy that nav2 reads,
0 to 100, and 255 is unknown, which its filters skip. The meaning of the values is described in docs/nav2.md.
"""

import csv
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from lifelore.core.learning.known_world import WorldModel
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.inflation import inflate
from lifelore.domains.buildings.occupancy_map import FREE, OccupancyMap, write_occupancy_map
from lifelore.domains.grids.grid_world import GridWorld

NO_OPINION, KEEP_OUT = 255, 100
"""Values of a mask: skipped by nav2's filters, and never entered."""
MOST_COST = 90
"""Largest cost of a place; nav2 takes values from 99 on nearly as an obstacle."""
BUMP_SHARE = 0.5
"""Part of the cost that comes from bumps; the rest comes from the prior."""
_ROWS = 512
"""Rows of a mask that are computed at a time; more need more memory."""
_COSTS = (
    "# Cost of driving here, 0 to 90: bumps in this place, and how seldom the action prior leads into it.\n"
    "# 255: no experience. A mask for nav2's KeepoutFilter, see docs/nav2.md.\n"
)
_KEEPOUT = (
    "# 100: no place that the robot knows, 0: space of known places.\n"
    "# A mask for nav2's KeepoutFilter, see docs/nav2.md.\n"
)


def known_places(model: WorldModel) -> NDArray[np.bool_]:
    """(n_states,) states that the robot has visited."""
    return model.percept >= 0


def place_costs(world: GridWorld, model: WorldModel, probs: NDArray[np.float64] | None) -> NDArray[np.uint8]:
    """The cost of each known place, (n_states,) in [0, `MOST_COST`]; `NO_OPINION` for other places.

    cost = 100 · (`BUMP_SHARE` · bumps + (1 - `BUMP_SHARE`) · disfavour), at most `MOST_COST`

    Bumps is the share of the place's tried moves that were refused. Disfavour is 1 - f, at least 0, where f is the
    sum of the probabilities of the moves from neighbouring places into this one: as many robots enter in one move
    if one stands in each neighbour. Two places have the largest cost at once if a move between them was refused
    that the map allows.

    Parameters
    ----------
    world : GridWorld
    model : WorldModel
        What the robot remembers.
    probs : (n_states, n_actions) float, optional
        The prior's probabilities; without a prior, disfavour is 0.
    """
    states = np.arange(world.n_states)[:, None]
    tried, refused = model.target >= 0, model.target == states
    bumps = refused.sum(axis=1) / np.maximum(tried.sum(axis=1), 1)
    disfavour = np.zeros(world.n_states)
    tail, action = np.nonzero(world.neighbour >= 0)
    if probs is not None:
        into = np.bincount(world.neighbour[tail, action], probs[tail, action], world.n_states)
        disfavour = np.clip(1 - into, 0, 1)
    cost = np.rint(100 * (BUMP_SHARE * bumps + (1 - BUMP_SHARE) * disfavour))
    state, action = np.nonzero(refused & (world.neighbour >= 0))
    cost[state] = cost[world.neighbour[state, action]] = MOST_COST
    return np.where(known_places(model), np.minimum(cost, MOST_COST), NO_OPINION).astype(np.uint8)


def body_space(floor: Floor, known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(rows, columns) pixels that the robot's body covers somewhere when its centre is in a known place.

    A mask of the centres alone would stop a planner that compares the robot's footprint with the costmap.
    """
    centres = (floor.state >= 0) & known[np.maximum(floor.state, 0)]
    return inflate(centres, floor.radius)


def cost_mask(floor: Floor, costs: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The cost at each pixel of the floor's map: that of the nearest place within the robot's body.

    `NO_OPINION` outside of known places and on pixels that the map does not show as free.
    """
    nearest = ndimage.distance_transform_edt(floor.state < 0, return_distances=False, return_indices=True)
    mask = costs[floor.state[tuple(np.asarray(nearest))]]
    known = body_space(floor, costs != NO_OPINION) & (floor.occupancy.state == FREE)
    return np.where(known, mask, NO_OPINION).astype(np.uint8)


def keepout_mask(floor: Floor, known: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """`KEEP_OUT` at each pixel of the floor's map where the robot's body never is in a known place, else 0."""
    return np.where(body_space(floor, known), 0, KEEP_OUT).astype(np.uint8)


def on_map(mask: NDArray[np.uint8], floor: Floor, occupancy: OccupancyMap, outside: int) -> NDArray[np.uint8]:
    """A mask of the floor's pixels on the pixels of the user's own map; `outside` where the floor has none."""
    rows, columns = occupancy.state.shape
    own = Floor(occupancy, np.empty((rows, columns), np.int32), np.empty((0, 0), np.bool_), 0.0, 0)
    found = np.full((rows, columns), outside, np.uint8)
    for top in range(0, rows, _ROWS):
        row, column = np.mgrid[top : min(top + _ROWS, rows), 0:columns]
        at = np.rint(floor.pixels(own.metres(np.column_stack([row.ravel(), column.ravel()])))).astype(np.int64)
        inside = ((at >= 0) & (at < mask.shape)).all(axis=1)
        part = np.full(len(at), outside, np.uint8)
        part[inside] = mask[tuple(at[inside].T)]
        found[top : top + _ROWS] = part.reshape(row.shape)
    return found


def write_masks(
    folder: Path, world: GridWorld, model: WorldModel, probs: NDArray[np.float64] | None, floor: Floor,
    occupancy: OccupancyMap,
) -> None:  # fmt: skip
    """Write ``costs.yaml`` and ``keepout.yaml`` with their images, on the grid of the user's map `occupancy`.

    Raises
    ------
    StoreError
        The files cannot be written.
    """
    costs = place_costs(world, model, probs)
    masks = {
        "costs": (cost_mask(floor, costs), NO_OPINION, _COSTS),
        "keepout": (keepout_mask(floor, known_places(model)), KEEP_OUT, _KEEPOUT),
    }
    for name, (mask, outside, meaning) in masks.items():
        path = folder / f"{name}.yaml"
        grey = on_map(mask, floor, occupancy, outside)
        write_occupancy_map(path, grey, occupancy.resolution, occupancy.origin, mode="raw")
        path.write_text(meaning + path.read_text(encoding="utf-8"), encoding="utf-8")


def write_directions(
    path: Path, world: GridWorld, probs: NDArray[np.float64], counted: NDArray[np.bool_], floor: Floor | None
) -> None:
    """Write the prior as CSV: x, y (metres), dx, dy (unit vector of a move), probability; four lines a place.

    Places without counts are left out. With a floor, x and y are the point of the place farthest from obstacles,
    otherwise the centre of the cell.
    """
    states = np.flatnonzero(counted).astype(np.int32)
    points = world.positions(states) if floor is None else floor.metres(floor.anchors[states])
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["x", "y", "dx", "dy", "probability"])
        for state, (x, y) in zip(states, points, strict=True):
            for (dx, dy), probability in zip(world.move_vectors, probs[state], strict=True):
                # Adding 0 turns -0.0 into 0.0.
                row = (x, y, dx, dy, probability)
                writer.writerow([f"{round(float(value), 4) + 0:.4f}" for value in row])
