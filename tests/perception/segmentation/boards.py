"""Upright boxes, and the rays of a simulated camera that meet them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Board:
    """A box that stands upright: `middle` and `half` sizes (x, y, z) in metres, turned by `yaw` radians about z.

    `kind` is a name.
    """

    kind: str
    middle: tuple[float, float, float]
    half: tuple[float, float, float]
    yaw: float = 0.0


def cast_boards(
    boards: Sequence[Board], origin: NDArray[np.float64], rays: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """The board that each ray meets first.

    Parameters
    ----------
    boards : sequence of Board
    origin : (3,) float64
    rays : (m, 3) float64

    Returns
    -------
    number : (m,) int64
        Index of the board; −1 for none.
    along : (m,) float64
        Ray lengths to it; infinite for none. A board that holds the origin is not met.
    normal : (m, 3) float64
        Outer normal of the face; zeros for none.
    """
    m = len(rays)
    number, along, normal = np.full(m, -1, np.int64), np.full(m, np.inf), np.zeros((m, 3))
    x, y, z = np.ascontiguousarray(rays.T)
    for index, board in enumerate(boards):
        cosine, sine = np.cos(board.yaw), np.sin(board.yaw)
        turn = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        start = turn @ (origin - board.middle)
        ways = (cosine * x + sine * y, cosine * y - sine * x, z)
        enters, leaves, axis = np.full(m, -np.inf), np.full(m, np.inf), np.zeros(m, np.int64)
        for k, way in enumerate(ways):
            inverse = 1.0 / np.where(way == 0, 1e-12, way)
            middle, reach = -start[k] * inverse, board.half[k] * np.abs(inverse)
            axis[middle - reach > enters] = k
            np.fmax(enters, middle - reach, out=enters)
            np.fmin(leaves, middle + reach, out=leaves)
        met = np.flatnonzero((enters <= leaves) & (enters > 0) & (enters < along))
        number[met], along[met] = index, enters[met]
        face = np.zeros((len(met), 3))
        for k, way in enumerate(ways):
            face[:, k] = np.where(axis[met] == k, -np.sign(way[met]), 0.0)
        normal[met] = face @ turn
    return number, along, normal
