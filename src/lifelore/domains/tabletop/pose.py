"""`Pose`: where an object of the tabletop is and how it is turned; rotations as matrices, metres, z up."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Pose:
    """A rigid placement: ``world = rotation @ local + position``.

    Parameters
    ----------
    position : (3,) float64
        Metres.
    rotation : (3, 3) float64
        Orthonormal, determinant 1.
    """

    position: NDArray[np.float64]
    rotation: NDArray[np.float64]

    def apply(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Local points ``(n, 3)`` in the world."""
        return points @ self.rotation.T + self.position

    def moved(self, shift: NDArray[np.float64]) -> "Pose":
        """The same turn, `shift` metres further on."""
        return Pose(self.position + shift, self.rotation)

    def turned(self, yaw: float) -> "Pose":
        """Carried about the world's vertical axis through the origin, `yaw` radians."""
        turn = about(2, yaw)
        return Pose(turn @ self.position, turn @ self.rotation)


def about(axis: int, angle: float) -> NDArray[np.float64]:
    """Rotation by `angle` radians about coordinate axis 0, 1 or 2.

    Examples
    --------
    >>> about(2, np.pi / 2).round() @ [1, 0, 0]
    array([0., 1., 0.])
    """
    cosine, sine = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    rotation = np.eye(3)
    rotation[i, i], rotation[i, j], rotation[j, i], rotation[j, j] = cosine, -sine, sine, cosine
    return rotation


def random_rotation(rng: np.random.Generator) -> NDArray[np.float64]:
    """A rotation uniform over all turns."""
    rotation, triangle = np.linalg.qr(rng.normal(size=(3, 3)))
    rotation = rotation * np.sign(np.diag(triangle))
    if np.linalg.det(rotation) < 0:
        rotation[:, 0] *= -1
    return rotation


def aligned(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """A rotation whose third axis points along `direction` (any length but 0)."""
    third = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    helper = np.eye(3)[int(np.argmin(np.abs(third)))]
    first = np.cross(helper, third)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(third, first), third], axis=1)
