"""Measures how near a straight line passes to the obstacles of a floor."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import KDTree

from lifelore.domains.buildings.floor import Floor

_BESIDE = 1e-6
"""Pixels: a line through a corner, or along the border of two pixels, touches the pixels on both sides."""


class LineOfSight:
    """Straight lines over the pieces of a floor; all lengths in pixels.

    moves : (n, 2) pairs of states, or None: a line changes from piece to piece by these moves alone, or anywhere
    comfort : clearance that is large enough, one pixel more than the robot's radius
    """

    def __init__(self, floor: Floor, moves: NDArray[np.integer] | None = None) -> None:
        self._floor = floor
        self._moves = None if moves is None else move_codes(floor, moves)
        self.comfort = floor.radius + 1
        # The solid pixel nearest to a point of the floor always has a neighbour that is not solid.
        inner = np.asarray(ndimage.binary_erosion(floor.solid, np.ones((3, 3)), border_value=1), bool)
        self._rim = np.argwhere(floor.solid & ~inner)
        self._tree = KDTree(self._rim) if len(self._rim) else None

    def clearance(self, a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
        """Distance from a line to the nearest solid pixel centre, at most `comfort`; -1 if it leaves the floor."""
        if not self._inside(a, b):
            return -1.0
        if self._tree is None:
            return self.comfort
        length = float(np.hypot(*(b - a)))
        n = int(length / self.comfort) + 2
        samples = np.linspace(a, b, n)
        reach = np.hypot(self.comfort, length / (n - 1) / 2) + 1e-9
        near = np.unique(np.concatenate(self._tree.query_ball_point(samples, reach)).astype(np.int64))
        if not len(near):
            return self.comfort
        return min(self.comfort, float(_distances(self._rim[near], a, b).min()))

    def _inside(self, a: NDArray[np.float64], b: NDArray[np.float64]) -> bool:
        along = b - a
        length = float(np.hypot(*along))
        aside = np.array([-along[1], along[0]]) / length * _BESIDE if length else np.zeros(2)
        for shift in (aside, -aside):
            row, column = pixels_on_line(a + shift, b + shift).T
            rows, columns = self._floor.state.shape
            if row.min() < 0 or column.min() < 0 or row.max() >= rows or column.max() >= columns:
                return False
            state = self._floor.state[row, column]
            if (state < 0).any() or not self._moves_allowed(state):
                return False
        return True

    def _moves_allowed(self, state: NDArray[np.int32]) -> bool:
        if self._moves is None:
            return True
        changes = np.flatnonzero(state[1:] != state[:-1])
        codes = state[changes].astype(np.int64) * self._floor.n_states + state[changes + 1]
        place = np.minimum(np.searchsorted(self._moves, codes), len(self._moves) - 1)
        return not len(codes) or bool(len(self._moves) and (self._moves[place] == codes).all())


def move_codes(floor: Floor, moves: NDArray[np.integer]) -> NDArray[np.int64]:
    """Moves (n, 2) as ascending numbers from · n_states + to."""
    return np.unique(np.asarray(moves, np.int64).reshape(-1, 2) @ np.array([floor.n_states, 1]))


def pixels_on_line(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.int64]:
    """The pixels that the line a–b passes through, (n, 2) rows and columns in order."""
    crossings = [np.array([0.0, 1.0])]
    for start, end in zip(a, b, strict=True):
        low, high = sorted((start, end))
        borders = np.arange(np.floor(low + 0.5) + 0.5, high)
        if high > low:
            crossings.append((borders - start) / (end - start))
    t = np.unique(np.concatenate(crossings))
    middle = (t[:-1] + t[1:]) / 2
    return np.rint(a + middle[:, None] * (b - a)).astype(np.int64)


def _distances(points: NDArray, a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance of each of `points`, (n, 2), from the line a–b."""
    along = b - a
    square = float(along @ along)
    t = np.clip((points - a) @ along / square, 0, 1) if square else np.zeros(len(points))
    return np.hypot(*(points - a - t[:, None] * along).T)
