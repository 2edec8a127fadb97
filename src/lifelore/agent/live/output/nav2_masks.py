"""Exports experience for nav2: masks for its costmap filters.

The masks have the mode ``raw``: a pixel's value is the occupancy that nav2 reads, 0 to 100, and 255 is unknown,
which its filters skip. They have the pixels of the user's map, or of its axis-aligned copy if the map is turned
(`axis_aligned`). The meaning of the values is described in docs/nav2.md.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from lifelore.agent.travel.move_costs import MoveCosts
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.inflation import inflate
from lifelore.domains.buildings.map_alignment import axis_aligned, resampled
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, OccupancyMap, write_occupancy_map

NO_OPINION, KEEP_OUT = 255, 100
"""Values of a mask: skipped by nav2's filters, and never entered."""
FULL_SPEED = 0
"""Value of a speed mask that nav2's filter takes for no limit."""
MOST_COST = 90
"""Largest cost of a place; nav2 takes values from 99 on nearly as an obstacle."""
SLOWEST = 10
"""Least percent of full speed in a speed mask; a robot that obeys a smaller one seems to stand still."""
LEAST = 10
"""Smallest cost, and smallest loss of speed in percent, that a mask shows; less is noise of what was observed."""
_MEANINGS = {
    "costs": "Time and risk of driving here, 0 to 90: 100 · (1 - cost of a usual place / cost of this place).\n"
    "# 255: no experience. A mask for nav2's KeepoutFilter",
    "speed": "Percent of the usual speed with which robots drive here; 0: no limit.\n"
    "# A mask for nav2's SpeedFilter",
    "keepout": "100: no place that the robot knows, or one that is blocked; 0: known space.\n"
    "# A mask for nav2's KeepoutFilter",
}


def place_costs(costs: MoveCosts, known: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """What driving in each place costs beyond the usual, (n_states,) in [0, `MOST_COST`]; else `NO_OPINION`.

    cost = 100 · (1 - usual cost / cost here), 0 below `LEAST`. The cost of a place is the mean of the moves into
    and out of it, their refusals included; usual is the median of the known places. Walls cost nothing: nav2
    inflates them itself.
    """
    value = 100 * _beyond_usual(costs.at_places(costs.cost), known)
    value = np.where(value >= LEAST, np.minimum(np.rint(value), MOST_COST), 0)
    return np.where(known, value, NO_OPINION).astype(np.uint8)


def place_speeds(costs: MoveCosts, known: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Percent of the usual speed at each known place that is slow, (n_states,); `FULL_SPEED` elsewhere.

    Usual is the median of the known places.
    """
    loss = 100 * _beyond_usual(costs.at_places(costs.seconds), known)
    percent = np.maximum(np.rint(100 - loss), SLOWEST)
    return np.where(known & (loss >= LEAST), percent, FULL_SPEED).astype(np.uint8)


def _beyond_usual(values: NDArray[np.float64], known: NDArray[np.bool_]) -> NDArray[np.float64]:
    """1 - usual value / value; 0 where a place has no moves."""
    usual = np.nanmedian(values[known]) if np.isfinite(values[known]).any() else np.nan
    return np.nan_to_num(1 - usual / values)


def body_space(floor: Floor, known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(rows, columns) pixels that the robot's body covers somewhere when its centre is in a known place.

    A mask of the centres alone would stop a planner that compares the robot's footprint with the costmap.
    """
    centres = (floor.state >= 0) & known[np.maximum(floor.state, 0)]
    return inflate(centres, floor.radius)


def place_masks(
    floor: Floor, known: NDArray[np.bool_], *values: tuple[NDArray[np.uint8], int]
) -> list[NDArray[np.uint8]]:
    """Masks on the pixels of the floor's map, each of the values of all places and a value for other pixels.

    A pixel has the value of the nearest place. Other pixels are those outside of known places, and those that the
    map does not show as free.
    """
    nearest = ndimage.distance_transform_edt(floor.state < 0, return_distances=False, return_indices=True)
    place = floor.state[tuple(np.asarray(nearest))]
    space = body_space(floor, known) & (floor.occupancy.state == FREE)
    return [np.where(space, own[place], other).astype(np.uint8) for own, other in values]


def keepout_mask(floor: Floor, known: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """`KEEP_OUT` at each pixel of the floor's map where the robot's body never is in a known place, else 0."""
    return np.where(body_space(floor, known), 0, KEEP_OUT).astype(np.uint8)


def on_map(mask: NDArray[np.uint8], floor: Floor, occupancy: OccupancyMap, outside: int) -> NDArray[np.uint8]:
    """A mask of the floor's pixels on those of another map of the ground; `outside` where the floor has none."""
    if mask.shape == occupancy.state.shape and occupancy.origin == floor.occupancy.origin:
        return mask.copy()
    return resampled(floor.occupancy, mask, outside, occupancy.frame, occupancy.state.shape)


def write_masks(
    folder: Path, costs: MoveCosts, known: NDArray[np.bool_], floor: Floor, given: OccupancyMap
) -> None:
    """Write ``costs``, ``speed`` and ``keepout``, each as YAML and image, for the user's map `given`.

    nav2's costmaps ignore the yaw of an origin, so a turned map gets masks on its axis-aligned copy, in the same
    frame. Every point that the given map shows as occupied lies in a pixel with `KEEP_OUT`, and so does a place
    that is now more likely blocked than open.

    Raises
    ------
    StoreError
        The files cannot be written.
    """
    target = axis_aligned(given)
    values = (place_costs(costs, known), NO_OPINION), (place_speeds(costs, known), FULL_SPEED)
    cost, speed = place_masks(floor, known, *values)
    masks = {
        "costs": (cost, NO_OPINION),
        "speed": (speed, FULL_SPEED),
        "keepout": (keepout_mask(floor, known & ~costs.closed()), KEEP_OUT),
    }
    for name, (mask, outside) in masks.items():
        path = folder / f"{name}.yaml"
        grey = on_map(mask, floor, target, outside)
        if name == "keepout":
            walls = target.pixels(given.metres(np.argwhere(given.state == OCCUPIED)))
            grey[tuple(np.rint(walls).astype(np.int64).T)] = KEEP_OUT
        write_occupancy_map(path, grey, target.resolution, target.origin, mode="raw")
        text = f"# {_MEANINGS[name]}, see docs/nav2.md.\n"
        path.write_text(text + path.read_text(encoding="utf-8"), encoding="utf-8")
