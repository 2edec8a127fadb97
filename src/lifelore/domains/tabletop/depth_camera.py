"""Depth cameras on plain arrays: rays, and what a Kinect or a stereo rig makes of true depth.

Camera frame: x right, y down, z forward; depth is z in metres. Both sensors measure disparity d = f·b / z.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from lifelore.domains.tabletop.pose import Pose


@dataclass(frozen=True)
class Camera:
    """A pinhole camera and the noise of its depth.

    Parameters
    ----------
    width, height : int
        Pixels.
    focal : float
        Pixels; the principal point is the middle of the image.
    baseline : float
        Metres between the two eyes, or eye and projector.
    quantum : float
        Disparities are multiples of it, pixels; 0: not quantised.
    local_noise : float
        Standard deviation of a disparity error that neighbouring pixels share over `correlation` pixels.
    drift : float
        Standard deviation of a slow error over `drift_length` pixels: what is left of lens distortion.
    edge_dropout : float
        Probability that a pixel beside a jump in depth gives no depth.
    shadows : bool
        Whether points the projector does not see are lost.
    """

    name: str
    width: int = 640
    height: int = 480
    focal: float = 525.0
    baseline: float = 0.075
    quantum: float = 0.125
    local_noise: float = 0.07
    correlation: float = 0.8
    drift: float = 0.115
    drift_length: float = 60.0
    edge_dropout: float = 0.5
    shadows: bool = True

    @property
    def centre(self) -> tuple[float, float]:
        """Principal point, pixels."""
        return (self.width - 1) / 2, (self.height - 1) / 2

    def rays(self, columns: NDArray[np.int64], rows: NDArray[np.int64]) -> NDArray[np.float64]:
        """Directions ``(…, 3)`` of pixels in the camera frame, z = 1: a ray's length in rays is its depth."""
        cx, cy = self.centre
        u, v = np.broadcast_arrays(columns, rows)
        return np.stack([(u - cx) / self.focal, (v - cy) / self.focal, np.ones(u.shape)], axis=-1)

    def project(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Pixels (column, row) ``(n, 2)`` of points in the camera frame."""
        return points[:, :2] / points[:, 2:] * self.focal + self.centre

    def sigma(self, depth: float) -> float:
        """Standard deviation of measured depth on a face-on surface, metres."""
        disparity = np.hypot(np.hypot(self.local_noise, self.drift), self.quantum / np.sqrt(12))
        return float(depth**2 / (self.focal * self.baseline) * disparity)


KINECT = Camera("kinect")
"""Structured light: f 525 px, baseline 75 mm, 1/8 px; 1.9 mm at 0.73 m, of which 1 mm from pixel to pixel."""

STEREO = Camera(
    "stereo", 640, 480, 1000.0, 0.12, 0.0, local_noise=0.075, correlation=1.5, drift=0.0056,
    drift_length=40.0, edge_dropout=0.15, shadows=False,
)  # fmt: skip
"""Two close eyes over a small table: dense, at 0.8 m 0.03 mm of drift under 0.4 mm of matching jitter."""

CAMERAS = {camera.name: camera for camera in (KINECT, STEREO)}


def looking_down(height: float, tilt: float, roll: float, distance: float) -> Pose:
    """Pose of a camera `height` m over the table that looks along +y and `tilt` radians down.

    Its place is such that the table's origin is `distance` metres deep in the picture.
    """
    sine, cosine = np.sin(tilt), np.cos(tilt)
    back = (distance - height * sine) / cosine
    axes = np.array([[1, 0, 0], [0, -sine, cosine], [0, -cosine, -sine]])
    turn = np.array([[np.cos(roll), -np.sin(roll), 0], [np.sin(roll), np.cos(roll), 0], [0, 0, 1]])
    return Pose(np.array([0.0, -back, height]), axes @ turn)


def measure(depth: NDArray[np.float64], camera: Camera, rng: np.random.Generator) -> NDArray[np.float64]:
    """What the camera reports where the true depth is `depth`: noisy, NaN where it sees nothing.

    Parameters
    ----------
    depth : (rows, columns) float64
        Metres; infinite where nothing is.
    camera : Camera
    rng : numpy.random.Generator
    """
    seen = np.isfinite(depth)
    disparity = np.where(seen, camera.focal * camera.baseline / np.where(seen, depth, 1.0), 0.0)
    lost = ~seen | _edges(disparity, camera, rng)
    if camera.shadows:
        lost |= shadowed(disparity)
    noisy = disparity + _smooth_noise(depth.shape, camera.local_noise, camera.correlation, rng)
    noisy += _smooth_noise(depth.shape, camera.drift, camera.drift_length, rng)
    if camera.quantum:
        noisy = np.round(noisy / camera.quantum) * camera.quantum
    return np.where(lost, np.nan, camera.focal * camera.baseline / np.maximum(noisy, 1e-3))


def shadowed(disparity: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Pixels that a projector on the right does not light: something nearer in the row lies in its way.

    The projector sees pixel column u at u − d(u); of pixels it sees at one place only the nearest is lit.
    """
    columns = np.arange(disparity.shape[1]) - disparity
    nearest = np.minimum.accumulate(columns[:, ::-1], axis=1)[:, ::-1]
    hidden = np.zeros(disparity.shape, dtype=bool)
    hidden[:, :-1] = nearest[:, 1:] < columns[:, :-1] - 0.5
    return hidden


def _edges(disparity: NDArray[np.float64], camera: Camera, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Pixels lost beside a jump of depth, on either side: the matching window straddles it."""
    jump = np.zeros(disparity.shape, dtype=bool)
    for axis in (0, 1):
        step = np.abs(np.diff(disparity, axis=axis)) > 1.0
        before, after = (slice(None, -1), slice(1, None))
        index = [slice(None)] * 2
        for side in (before, after):
            index[axis] = side
            jump[tuple(index)] |= step
    wide = ndimage.binary_dilation(jump)
    chance = np.where(jump, camera.edge_dropout, np.where(wide, camera.edge_dropout / 3, 0.0))
    return rng.random(disparity.shape) < chance


def _smooth_noise(
    shape: tuple[int, ...], sigma: float, length: float, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Gaussian noise of standard deviation `sigma`, alike over about `length` pixels."""
    if sigma == 0:
        return np.zeros(shape)
    if length > 8:
        # A coarse lattice, interpolated: a wide Gaussian filter would cost more than the rays.
        coarse = rng.normal(0, 1, [int(n / length) + 3 for n in shape])
        rows, columns = (_hat_weights(n, length, rng.random()) for n in shape)
        # A hat of unit noise keeps (2/3)² of its variance on average over the lattice.
        return sigma * 1.5 * (rows @ coarse[:, : columns.shape[1]] @ columns.T)
    noise = ndimage.gaussian_filter(rng.normal(0, 1, shape), length, truncate=3.0, mode="wrap")
    return sigma * noise * (2 * np.sqrt(np.pi) * length)


def _hat_weights(n: int, length: float, offset: float) -> NDArray[np.float64]:
    """Linear interpolation weights ``(n, lattice points)`` of pixels on a lattice of step `length`."""
    place = np.arange(n) / length + offset
    return np.maximum(0.0, 1.0 - np.abs(place[:, None] - np.arange(int(n / length) + 3)))
