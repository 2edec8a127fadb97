"""Depth images and masks of simulated scenes: the same cloud and the same relations as the labelled cloud's."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from lifelore.agent.perceive.perceive import PerceiveSettings, perceive
from lifelore.agent.perceive.perceive_many import perceive_folder, perceive_many
from lifelore.agent.perceive.source_files import SourceFiles
from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.domains.tabletop.depth_camera import KINECT
from lifelore.domains.tabletop.settings import TabletopScene
from lifelore.domains.tabletop.tabletop import sample_scene
from lifelore.perception.clouds.camera_intrinsics import CameraIntrinsics
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.segmentation.table_labels import with_table

pytest.importorskip("mujoco")
INTRINSICS = {
    "fx": KINECT.focal, "fy": KINECT.focal, "cx": KINECT.centre[0], "cy": KINECT.centre[1],
    "width": KINECT.width, "height": KINECT.height,
}  # fmt: skip


@pytest.fixture(scope="module")
def scene() -> TabletopScene:
    return sample_scene(5, 0)


def images(scene: TabletopScene) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Depth in metres, colours and labels of the simulated camera's image; its points lie on the pixels' rays."""
    local = (scene.cloud.points - scene.view.position) @ scene.view.rotation
    pixels = KINECT.project(local)
    columns, rows = np.rint(pixels).astype(int).T
    np.testing.assert_allclose(pixels, np.stack([columns, rows], axis=1), atol=1e-6)
    depth = np.zeros((KINECT.height, KINECT.width))
    depth[rows, columns] = local[:, 2]
    colours = np.zeros((*depth.shape, 3), np.uint8)
    assert scene.cloud.colours is not None
    colours[rows, columns] = scene.cloud.colours
    labels = np.zeros(depth.shape, np.uint8)
    labels[rows, columns] = scene.cloud.labels
    return depth, colours, labels


@pytest.fixture
def folder(scene: TabletopScene, tmp_path: Path) -> Path:
    """A depth image in both forms, its intrinsics and colours, and the objects' labels as masks."""
    depth, colours, labels = images(scene)
    np.save(tmp_path / "depth.npy", depth)
    Image.fromarray(np.rint(depth * 1000).astype(np.uint16)).save(tmp_path / "depth.png")
    Image.fromarray(colours).save(tmp_path / "rgb.png")
    Image.fromarray(labels).save(tmp_path / "all.png")
    Image.fromarray(np.where(labels > TABLE, labels, 0).astype(np.uint8)).save(tmp_path / "objects.png")
    (tmp_path / "camera.json").write_text(json.dumps(INTRINSICS))
    return tmp_path


def test_a_depth_image_gives_the_points_of_the_simulated_camera(scene: TabletopScene) -> None:
    depth, _, _ = images(scene)
    cloud = PointCloud.from_depth(depth, CameraIntrinsics(**INTRINSICS))
    world = cloud.points[cloud.measured] @ scene.view.rotation.T + scene.view.position
    # Images are row by row, and so is the simulated cloud.
    np.testing.assert_allclose(world, scene.cloud.points, atol=1e-9)
    rounded = PointCloud.from_depth(np.rint(depth * 1000).astype(np.uint16), CameraIntrinsics(**INTRINSICS))
    # Half a millimetre of depth, on rays of slope up to 0.75.
    assert np.nanmax(np.linalg.norm(rounded.points - cloud.points, axis=1)) <= 0.0005 * 1.25 + 1e-6


def relations(document: dict) -> set[tuple]:
    return {(r["relation"], r["a"], r["b"]) for r in document["relations"]}


def settings(folder: Path, **files) -> PerceiveSettings:
    named = {name: str(folder / file) if isinstance(file, str) else file for name, file in files.items()}
    return PerceiveSettings(beside=SourceFiles(str(folder / "camera.json"), **named))


def test_masks_of_all_give_the_relations_of_the_labelled_cloud(scene: TabletopScene, folder: Path) -> None:
    local = (scene.cloud.points - scene.view.position) @ scene.view.rotation
    # Mask 1 is the table, and mask N object N + 1; so the labels become 1, 3, 4, …
    labels = np.where(scene.cloud.labels > TABLE, scene.cloud.labels + 1, scene.cloud.labels)
    expected = perceive(PointCloud(local, labels, scene.cloud.colours, camera=np.zeros(3)))
    found = perceive(str(folder / "depth.npy"), settings(folder, masks="all.png", table_mask=TABLE))
    assert relations(found) == relations(expected)
    assert len(relations(found)) > 2


def test_without_a_mask_of_the_table_its_plane_is_the_table(scene: TabletopScene, folder: Path) -> None:
    with_mask = perceive(
        str(folder / "depth.png"), settings(folder, colour="rgb.png", masks="all.png", table_mask=TABLE)
    )
    without = perceive(str(folder / "depth.png"), settings(folder, colour="rgb.png", masks="objects.png"))
    assert relations(without) == relations(with_mask)


def test_a_plane_that_is_not_level_is_no_table(scene: TabletopScene) -> None:
    labels = np.where(scene.cloud.labels > TABLE, scene.cloud.labels, 0)
    cloud = PointCloud(scene.cloud.points, labels)
    for up in ("table", "z", (0.0, 0.0, 2.0)):
        found = with_table(cloud, up).labels
        on_table = scene.cloud.labels == TABLE
        assert (found[on_table] == TABLE).mean() > 0.95
        assert np.array_equal(found[~on_table & (found != TABLE)], labels[~on_table & (found != TABLE)])
    assert with_table(cloud, (1.0, 0.0, 0.0)) is cloud
    labelled = replace(cloud, labels=scene.cloud.labels)
    assert with_table(labelled) is labelled


def test_mistakes_before_anything_is_read(folder: Path) -> None:
    for wrong, said in [
        ({"colour": "rgb.png"}, "colour.*belongs to a depth image"),
        ({"depth_scale": 0.001}, "depth_scale=S.*belongs to a depth image"),
        ({"table_mask": 1}, "give --masks FILE"),
        ({"masks": "m.png", "table_mask": 0}, "from 1, got 0"),
    ]:
        with pytest.raises(InputError, match=said):
            SourceFiles(**wrong)
    depth = str(folder / "depth.png")
    with pytest.raises(InputError, match="is a cloud: leave them out"):
        perceive("table.pcd", settings(folder))
    with pytest.raises(InputError, match="depth_scale=S instead"):
        perceive(depth, replace(settings(folder), units="mm"))
    with pytest.raises(InputError, match="would be overwritten"):
        perceive(depth, settings(folder, masks="all.png"), plot=str(folder / "all.png"))
    with pytest.raises(InputError, match="one file for many clouds"):
        perceive_many([depth, depth], settings(folder, masks="all.png"))
    from threading import Event

    with pytest.raises(InputError, match="watch perceives clouds alone"):
        perceive_folder(folder, settings(folder), stop=Event())


def test_names_of_files_follow_the_cloud(folder: Path) -> None:
    for number in "12":
        (folder / f"d{number}.npy").write_bytes((folder / "depth.npy").read_bytes())
        (folder / f"mask-d{number}.png").write_bytes((folder / "objects.png").read_bytes())
    found = list(
        perceive_many([str(folder / "d1.npy"), str(folder / "d2.npy")], settings(folder, masks="mask-{name}.png"))
    )
    assert [len(entry["objects"]) for entry in found] == [len(found[0]["objects"])] * 2
    assert relations(found[0]) == relations(found[1])
