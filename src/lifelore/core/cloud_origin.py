"""`CloudOrigin`: the frame, the pose and the pixels that the points of a scene come from."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError


class SensorFrame(NamedTuple):
    """Name and time of the frame in which a sensor measured; None where the source does not say.

    name : frame_id of ROS; stamp : seconds
    """

    name: str | None = None
    stamp: float | None = None


NO_FRAME = SensorFrame()


@dataclass(frozen=True, eq=False)
class CloudOrigin:
    """The way from the points of a scene back to the cloud that was read.

    The frame in which the cloud was read is called the camera's, whatever sensor it is.

    Parameters
    ----------
    T_scene_camera : (4, 4) float64
        Rigid motion from the camera's frame to the scene's; metres. Default: the two frames are one.
    frame : SensorFrame
    rows : (n,) int64, optional
        Row of each point in the cloud that was read; in an organised cloud that is the number of its pixel, row
        by row from 0. None where points are means of several, as in a thinned cloud or one of several views.
    grid : (height, width), optional
        Pixels of the image, if the cloud was organised.

    Raises
    ------
    InputError
        The shape of the motion is wrong.

    Examples
    --------
    >>> CloudOrigin().T_camera_scene.round(1)[0].tolist()
    [1.0, 0.0, 0.0, 0.0]
    """

    T_scene_camera: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    frame: SensorFrame = NO_FRAME
    rows: NDArray[np.int64] | None = None
    grid: tuple[int, int] | None = None

    def __post_init__(self) -> None:
        if self.T_scene_camera.shape != (4, 4):
            raise InputError(f"T_scene_camera must have shape (4, 4), got {self.T_scene_camera.shape}")

    @property
    def T_camera_scene(self) -> NDArray[np.float64]:
        """(4, 4) float64 motion from the scene's frame to the camera's."""
        turn = self.T_scene_camera[:3, :3].T
        back = np.eye(4)
        back[:3, :3], back[:3, 3] = turn, -turn @ self.T_scene_camera[:3, 3]
        return back

    @property
    def pixels(self) -> NDArray[np.int64] | None:
        """(n, 2) int64 row and column of each point in the image; None where there is no image."""
        if self.grid is None or self.rows is None:
            return None
        return np.stack(np.divmod(self.rows, self.grid[1]), axis=1)

    def in_camera(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(…, 3) points of the scene in the camera's frame, metres."""
        return (points - self.T_scene_camera[:3, 3]) @ self.T_scene_camera[:3, :3]

    def turned_to_camera(self, directions: NDArray[np.float64]) -> NDArray[np.float64]:
        """(…, 3) directions of the scene in the camera's frame."""
        return directions @ self.T_scene_camera[:3, :3]


SCENE_ITSELF = CloudOrigin()
"""Origin of a scene that was made by hand: its frame is also the camera's."""
