"""A folder of labelled scenes: ``NAME.pcd`` each, `relations.csv`, `planes.csv` and `gaps.csv`.

The format of the Object Segmentation Database's modified edition as kept for tests: points in the camera frame
(x right, y down, z forward, metres), ``label // 10`` an object's number (20, 30, …), 1 the table.
"""

import csv
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError, StoreError
from lifelore.core.labelled_cloud import TABLE
from lifelore.domains.tabletop.tabletop import TabletopScene

RELATIONS = ("scene", "a", "b", "relation", "confidence")
PLANES = ("scene", "nx", "ny", "nz", "d")
GAPS = ("scene", "a", "b", "visible_gap", "true_gap")
OURS = ("relations.csv", "planes.csv", "gaps.csv", "sim*.pcd")
_FIELDS = ("label", "x", "y", "z", "rgba")
_TYPES = (np.uint32, np.float32, np.float32, np.float32, np.uint32)


class SceneFolder:
    """A folder that scenes are written to one by one; made with the first of them.

    Parameters
    ----------
    path : str or Path
        A new folder, or one that holds no scenes.

    Raises
    ------
    InputError
        `path` is a file, or already holds scenes, or a file that scenes would be mixed with or overwrite.
    """

    def __init__(self, path: str | Path) -> None:
        self._path = Path(path)
        if self._path.is_file():
            raise InputError(f"out must be a folder, got the file '{path}': name another")
        there = next((name for name in OURS for _ in self._path.glob(name)), None)
        if there is not None:
            raise InputError(f"out must hold no scenes yet, '{path}' has a {there}: name another folder")
        self._begun = False

    def write(self, scene: TabletopScene) -> None:
        """Add one scene: its cloud and its rows.

        Raises
        ------
        StoreError
            The disk refuses.
        """
        try:
            self._begin()
            save_cloud(self._path / f"{scene.name}.pcd", scene)
            truth = [(scene.name, label.a, label.b, label.relation, label.confidence) for label in scene.truth]
            self._append("relations", truth)
            self._append("planes", [(scene.name, *(f"{value:.6f}" for value in plane_of(scene)))])
            rows = [(scene.name, g.a, g.b, f"{g.visible:.5f}", f"{g.true:.5f}") for g in scene.gaps]
            self._append("gaps", rows)
        except OSError as error:
            raise StoreError(f"cannot write scene '{scene.name}' to '{self._path}': {error.strerror}") from None

    def _begin(self) -> None:
        if not self._begun:
            self._path.mkdir(parents=True, exist_ok=True)
            for name, columns in (("relations", RELATIONS), ("planes", PLANES), ("gaps", GAPS)):
                self._append(name, [columns])
            self._begun = True

    def _append(self, name: str, rows: Iterable[tuple]) -> None:
        with open(self._path / f"{name}.csv", "a", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)


def plane_of(scene: TabletopScene) -> NDArray[np.float64]:
    """The table in the camera frame, ``(nx, ny, nz, d)``: n·p + d is the height above the table."""
    return np.append(scene.view.rotation[2], scene.view.position[2])


def save_cloud(path: Path, scene: TabletopScene) -> None:
    """The scene's points in the camera frame as a compressed binary PCD."""
    from pypcd4.pypcd4 import Encoding, PointCloud

    cloud = scene.cloud
    local = (cloud.points - scene.view.position) @ scene.view.rotation
    colours = cloud.colours if cloud.colours is not None else np.full((len(local), 3), 128, np.uint8)
    red, green, blue = colours.astype(np.uint32).T
    labels = np.where(cloud.labels > TABLE, 10 * cloud.labels, cloud.labels)
    columns = [labels, *local.T, 255 << 24 | red << 16 | green << 8 | blue]
    arrays = [np.ascontiguousarray(column, dtype=kind) for column, kind in zip(columns, _TYPES, strict=True)]
    PointCloud.from_points(arrays, _FIELDS, _TYPES).save(path, encoding=Encoding.BINARY_COMPRESSED)
