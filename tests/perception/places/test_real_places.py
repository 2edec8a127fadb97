"""Every object of every real scene, taken back into the image in which it was seen."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from lifelore.perception import Scene, read_cloud, to_scene
from lifelore.perception.places.object_box import ObjectBox
from lifelore.perception.places.object_mask import label_image
from lifelore.perception.scene_json import scene_document

DATA = Path(os.environ.get("LIFELORE_DATA", "nowhere"))
FILES = sorted([*DATA.glob("osd/*.pcd"), *DATA.glob("osd_hard/*.pcd")])
CORNERS = np.stack(np.meshgrid(*[[-0.5, 0.5]] * 3), axis=-1).reshape(-1, 3)


def fitted_camera(points: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """(2, 2): focal length and centre of columns and of rows, by least squares; pixels as (row, column)."""
    slopes = points[:, :2] / points[:, 2:]
    return np.stack([np.polyfit(slopes[:, axis], pixels[:, 1 - axis], 1) for axis in (0, 1)])


def decoded(mask: dict) -> np.ndarray:
    flat = np.repeat(np.arange(len(mask["counts"])) % 2 == 1, mask["counts"])
    return flat.reshape(mask["size"][::-1]).T


def covered(box: ObjectBox, camera: np.ndarray, pixels: np.ndarray) -> float:
    """The share of pixels (row, column) within the outline of the projected box, to a pixel."""
    corners = box.centre + (CORNERS * box.size) @ box.axes
    at = corners[:, :2] / corners[:, 2:] * camera[:, 0] + camera[:, 1]
    outline = ConvexHull(at).equations
    return float((outline[:, :2] @ pixels[:, ::-1].T + outline[:, 2:] <= 1).all(axis=0).mean())


@pytest.mark.slow
@pytest.mark.skipif(not FILES, reason="needs LIFELORE_DATA/osd")
@pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])
def test_masks_and_boxes_lie_on_the_picture(path):
    cloud = read_cloud(path)
    scene = to_scene(cloud)
    document = json.loads(json.dumps(scene_document(Scene(scene), with_masks=True), allow_nan=False))
    there, back = (np.array(document["frame"][key]) for key in ("scene_from_camera", "camera_from_scene"))
    assert there @ back == pytest.approx(np.eye(4), abs=1e-8)
    assert len(document["objects"]) == len(scene.objects) >= 2
    for one in document["objects"]:
        own = cloud.labels == one["id"]
        own &= cloud.measured
        points = cloud.points[own].astype(float)
        assert one["n_points"] == len(points)
        # The points of the file, taken to the scene by the document, are the scene's points.
        assert points @ there[:3, :3].T + there[:3, 3] == pytest.approx(scene.of(one["id"]), abs=1e-6)
        assert one["centroid_camera"] == pytest.approx(points.mean(axis=0), abs=1e-5)
        box = ObjectBox(*(np.array(one["box_camera"][key]) for key in ("centre", "axes", "size")))
        within = np.abs((points - box.centre) @ box.axes.T) <= box.size / 2 + 1e-5
        assert within.all(axis=1).mean() >= 0.99
        assert (box.size >= 0).all()
        assert 0.005 < box.size.max() < 0.6
        assert one["top"] == pytest.approx(one["box"]["centre"][2] + one["box"]["size"][2] / 2, abs=1e-5)
        if cloud.grid is None:
            assert one["points"] == np.flatnonzero(own).tolist()
            continue
        assert (decoded(one["mask"]) == own.reshape(cloud.grid)).all()
        assert ((label_image(scene) == one["id"]) == own.reshape(cloud.grid)).all()
        camera = fitted_camera(cloud.points[cloud.measured].astype(float), cloud.pixels[cloud.measured])
        assert camera == pytest.approx(np.array([[525, 319.5], [525, 239.5]]), abs=1)
        assert covered(box, camera, cloud.pixels[own]) >= 0.99
