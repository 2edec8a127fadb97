"""Picture of the four hardest shared scenes: hand-made labels, and objects found by two versions of the package.

``python -m docs.pictures.hard_scenes FOLDER``, with `LIFELORE_DATA` set; FOLDER is the checkout before.
"""

import os
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from lifelore.perception.clouds.cloud_file import read_cloud

ROOT = Path(__file__).parents[2]
SCENES = ("learn35", "test25", "test42", "test62")
FIND = """
import sys
import numpy as np
from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.segmentation.table_frame import to_scene
cloud = read_cloud(sys.argv[1])
try:
    labels = to_scene(PointCloud(cloud.points, colours=cloud.colours, camera=cloud.camera)).labels
except InputError as error:
    sys.exit(str(error))
np.save(sys.argv[2], labels)
"""


def found_by(checkout: Path, path: Path, place: Path) -> np.ndarray | None:
    """Labels of the measured points of a cloud; None where the version refuses the cloud."""
    environment = os.environ | {"PYTHONPATH": str(checkout / "src")}
    done = subprocess.run([sys.executable, "-c", FIND, str(path), str(place)], env=environment, check=False)
    return np.load(place) if done.returncode == 0 else None


def draw(axes: Axes, pixels: np.ndarray, labels: np.ndarray | None, window: tuple[slice, slice]) -> None:
    """The objects of an image in colours; the table is grey, and what was not measured is white."""
    axes.axis("off")
    if labels is None:
        axes.text(0.5, 0.5, "refused:\nno table", ha="center", va="center", transform=axes.transAxes)
        return
    colours = plt.get_cmap("tab20")(np.arange(20))[:, :3]
    image = np.ones((480, 640, 3))
    image[tuple(pixels.T)] = 0.88
    for order, label in enumerate(np.unique(labels[labels > 1])):
        image[tuple(pixels[labels == label].T)] = colours[(2 * order + order // 10) % 20]
    axes.imshow(image[window])


def main() -> None:
    old = Path(sys.argv[1])
    figure, grid = plt.subplots(len(SCENES), 3, figsize=(8, 8.5), layout="constrained")
    for row, name in zip(grid, SCENES, strict=True):
        path = Path(os.environ["LIFELORE_DATA"]) / "osd_hard" / f"{name}.pcd"
        cloud = read_cloud(path)
        cloud = cloud.only(cloud.measured)
        assert cloud.labels is not None
        pixels = cloud.pixels
        on_object = pixels[cloud.labels > 1]
        low, high = np.maximum(on_object.min(axis=0) - 20, 0), on_object.max(axis=0) + 20
        window = slice(low[0], high[0]), slice(low[1], high[1])
        place = ROOT / "out" / "labels.npy"
        place.parent.mkdir(exist_ok=True)
        for axes, labels in zip(
            row, (cloud.labels, found_by(old, path, place), found_by(ROOT, path, place)), strict=True
        ):
            draw(axes, pixels, labels, window)
    for axes, title in zip(grid[0], ("labels by hand", "before", "now"), strict=True):
        axes.set_title(title)
    figure.savefig(ROOT / "docs" / "pictures" / "hard_scenes.png", dpi=80)


if __name__ == "__main__":
    main()
