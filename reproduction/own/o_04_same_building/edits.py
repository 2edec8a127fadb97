"""A map as a mapper might save it again: turned, with noise, cropped, with some furniture elsewhere."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from lifelore.core.streams import stream
from lifelore.domains.buildings.map_alignment import MapFrame, aligned_map
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, OccupancyMap
from lifelore.domains.buildings.registration import composed


def turned(occupancy: OccupancyMap, degrees: float, resolution: float | None = None) -> OccupancyMap:
    """The same ground in a world frame that is turned, in pixels along its own axes, perhaps of another size."""
    pixel, angle = occupancy.resolution if resolution is None else resolution, np.radians(degrees)
    rows, columns = np.array(occupancy.state.shape) * occupancy.resolution
    cos, sin = abs(np.cos(angle)), abs(np.sin(angle))
    width, height = cos * columns + sin * rows, sin * columns + cos * rows
    # The middle of the old picture becomes the middle of the new one.
    pose = composed((width / 2, height / 2, angle), (-columns / 2, -rows / 2, 0.0))
    plain = replace(occupancy, origin=(0.0, 0.0, 0.0))
    laid = aligned_map(plain, pose, MapFrame((0.0, 0.0, 0.0), (width, height)), pixel, pixel)[0]
    return replace(laid, origin=(0.0, 0.0, 0.0))


def noisy(occupancy: OccupancyMap, seed: int = 0, share: float = 0.2) -> OccupancyMap:
    """`share` of the pixels on both sides of every wall are drawn anew, and a hundredth of it in open floor."""
    generator = stream(seed, "noisy map")
    state, around = occupancy.state.copy(), np.ones((3, 3))
    free, occupied = occupancy.state == FREE, occupancy.state == OCCUPIED

    def drawn(pixels: NDArray[np.bool_], part: float) -> NDArray[np.bool_]:
        return pixels & (generator.random(state.shape) < part)

    state[drawn(ndimage.binary_dilation(occupied, around) & free, share)] = OCCUPIED
    state[drawn(ndimage.binary_dilation(free, around) & occupied, share)] = FREE
    state[drawn(free, share / 100)] = OCCUPIED
    return replace(occupancy, state=state)


def cropped(occupancy: OccupancyMap, share: float) -> OccupancyMap:
    """The left part of the picture."""
    columns = int(occupancy.state.shape[1] * share)
    return replace(occupancy, state=np.ascontiguousarray(occupancy.state[:, :columns]))


def refurnished(occupancy: OccupancyMap, share: float, seed: int = 0) -> OccupancyMap:
    """`share` of the free-standing pieces of at most 4 m² stand elsewhere on free floor."""
    generator = stream(seed, "refurnished map")
    state = occupancy.state.copy()
    label, n = ndimage.label(state == OCCUPIED, np.ones((3, 3)))  # type: ignore[misc]
    boxes = ndimage.find_objects(label)
    small = np.flatnonzero(np.bincount(label.ravel(), minlength=n + 1)[1:] * occupancy.resolution**2 < 4)
    free = np.argwhere(state == FREE)
    for number in generator.permutation(small)[: round(share * len(small))]:
        piece = label[boxes[number]] == number + 1
        state[boxes[number]][piece] = FREE
        for row, column in free[generator.integers(len(free), size=20)]:
            there = state[row : row + piece.shape[0], column : column + piece.shape[1]]
            if there.shape == piece.shape and (there == FREE).all():
                there[piece] = OCCUPIED
                break
    return replace(occupancy, state=state)


EDITS: dict[str, Callable[[OccupancyMap, int], OccupancyMap]] = {
    "turned by 10°, noise": lambda m, n: noisy(turned(m, 10.0), n),
    "cropped to 60 %, turned by 3°": lambda m, n: turned(cropped(m, 0.6), 3.0),
    "a tenth of the furniture moved, turned, noise": lambda m, n: noisy(turned(refurnished(m, 0.1, n), 3.0), n),
    "three tenths moved, turned, noise": lambda m, n: noisy(turned(refurnished(m, 0.3, n), 3.0), n),
}
"""Name → an edit of an office that leaves it the same building; the number draws noise and furniture."""
