"""Several views of a simulated scene: with true or registered poses, they give the scene's relations once."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.perceive.perceive import PerceiveSettings
from lifelore.agent.perceive.source_files import SourceFiles
from lifelore.agent.perceive.views import perceive_views
from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.streams import stream
from lifelore.domains.tabletop.depth_camera import KINECT
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop.tabletop import sample_scene
from lifelore.perception.clouds.cloud_file import read_cloud
from reproduction.own.o_08_views_without_poses.run import views_around

pytest.importorskip("mujoco")


def matrix(pose: Pose) -> np.ndarray:
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = pose.rotation, pose.position
    return whole


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two views of a scene in their own frames, the same without labels, and their poses."""
    path = tmp_path_factory.mktemp("views")
    scene = sample_scene(5, 0)
    photos = views_around(scene, [0.0, 2.0], KINECT, stream(5, "tests", "views"))
    for name, photo in zip("ab", photos, strict=True):
        local = (photo.cloud.points - photo.view.position) @ photo.view.rotation
        np.savez(path / f"{name}.npz", points=local, labels=photo.cloud.labels, camera=np.zeros(3))
        np.savez(path / f"{name}-bare.npz", points=local, camera=np.zeros(3))
    (path / "poses.json").write_text(json.dumps([matrix(photo.view).tolist() for photo in photos]))
    return path


def names(folder: Path) -> list[str]:
    return [str(folder / "a.npz"), str(folder / "b.npz")]


def test_settings_are_checked_before_anything_is_read(folder: Path) -> None:
    nowhere = [str(folder / "no.npz"), str(folder / "none.npz")]
    for wrong, said in (
        ({"units": "ft"}, "units"),
        ({"labels": "some"}, "labels"),
        ({"up": "north"}, "up must be"),
    ):
        with pytest.raises(InputError, match=said):
            perceive_views(nowhere, PerceiveSettings(**wrong), poses=str(folder / "no.json"))


def test_two_views_give_one_scene(folder: Path) -> None:
    document = perceive_views(names(folder), PerceiveSettings(with_masks=True), poses=str(folder / "poses.json"))
    truth = {
        (label.a, "table" if label.b == TABLE else label.b)
        for label in sample_scene(5, 0).truth
        if label.relation == "on"
    }
    found = {(r["a"], r["b"]) for r in document["relations"] if r["relation"] == "on"}
    assert found == truth
    assert [view["source"] for view in document["views"]] == names(folder)
    np.testing.assert_allclose(document["views"][0]["pose"], np.eye(4), atol=1e-6)
    first, second = np.array(json.loads((folder / "poses.json").read_text()))
    np.testing.assert_allclose(document["views"][1]["pose"], np.linalg.inv(first) @ second, atol=1e-6)
    assert all(view["points"] > 10_000 for view in document["views"])
    assert all(one["points"] is None for one in document["objects"])
    # The camera of the document is the first view's: in it, the truth of that view's scene is found.
    first_view = read_cloud(names(folder)[0])
    assert first_view.labels is not None
    for one in document["objects"]:
        seen = first_view.points[first_view.labels == one["id"]]
        box = {key: np.array(value) for key, value in one["box_camera"].items()}
        within = np.abs((seen - box["centre"]) @ box["axes"].T) <= box["size"] / 2 + 0.003
        assert within.all(axis=1).mean() > 0.95


def test_views_without_labels_are_registered(folder: Path) -> None:
    said: list[str] = []
    bare = [str(folder / "a-bare.npz"), str(folder / "b-bare.npz")]
    document = perceive_views(bare, notice=said.append)
    first, second = np.array(json.loads((folder / "poses.json").read_text()))
    # Cameras 115° apart: 2° and 1 cm at 0.8 m are three times the errors of most pairs.
    error = np.linalg.inv(np.linalg.inv(first) @ second) @ np.array(document["views"][1]["pose"])
    assert np.degrees(np.arccos((np.trace(error[:3, :3]) - 1) / 2)) < 2.0
    assert np.linalg.norm(error[:3, :3] @ [0, 0, 0.8] + error[:3, 3] - [0, 0, 0.8]) < 0.01
    assert [view["registered_to"] for view in document["views"]] == [None, bare[0]]
    assert document["views"][0]["agreement"] is None
    assert document["views"][1]["agreement"] > 0.96
    assert said == [f"{bare[1]} is registered to {bare[0]}: {document['views'][1]['agreement']:.1%} of what both"
                    " show agrees"]  # fmt: skip


def test_views_that_cannot_be_registered_are_named(folder: Path, tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    np.savez(tmp_path / "noise.npz", points=rng.normal(size=(5000, 3)), camera=np.zeros(3))
    with pytest.raises(InputError, match=r"noise\.npz cannot be registered: no table was found.*--poses FILE"):
        perceive_views([str(folder / "a-bare.npz"), str(tmp_path / "noise.npz")])
    with pytest.raises(InputError, match=r"registration \(--register\) joins two or more clouds, got 1"):
        perceive_views([str(folder / "a-bare.npz")])


def test_views_between_which_an_object_moved_are_refused_with_its_place(tmp_path: Path) -> None:
    """97 % of what both views show agrees: the object that moved by 8 cm is a small part of it."""
    scene = sample_scene(91, 22, TabletopSettings(arrangement="varied"))
    poses = list(scene.poses)
    poses[2] = poses[2].moved(np.array([0.0, -0.08, 0.0]))
    (before,) = views_around(scene, [0.0], KINECT, stream(12, "a"))
    (after,) = views_around(replace(scene, poses=tuple(poses)), [0.4], KINECT, stream(12, "b"))
    for name, photo in (("before", before), ("after", after)):
        local = (photo.cloud.points - photo.view.position) @ photo.view.rotation
        np.savez(tmp_path / f"{name}.npz", points=local, camera=np.zeros(3))
    with pytest.raises(
        InputError, match=r"something moved between them, at .* m in the frame of the first"
    ) as said:
        perceive_views([str(tmp_path / "before.npz"), str(tmp_path / "after.npz")])
    place = [float(x) for x in str(said.value).split(", at ")[1].split(" m in")[0].split(", ")]
    found = before.view.position + before.view.rotation @ place
    assert np.linalg.norm(found[:2] - poses[2].position[:2]) < 0.02


def test_views_of_the_turned_camera_see_the_objects_where_they_are() -> None:
    scene = sample_scene(5, 0)
    (photo,) = views_around(scene, [0.0], KINECT, stream(5, "tests", "same view"))
    # The same camera without a turn: the same clean points, except at pixels that one of the two lost.
    keys = {tuple(point) for point in scene.clean.round(4)}
    assert np.mean([tuple(point) in keys for point in photo.clean.round(4)]) > 0.9


def test_what_does_not_go_together_is_refused(folder: Path) -> None:
    both, poses = names(folder), str(folder / "poses.json")
    with pytest.raises(InputError, match="two or more clouds"):
        perceive_views(both[:1], poses=poses)
    with pytest.raises(InputError, match="masks_out"):
        perceive_views(both, poses=poses, masks_out="numbers.png")
    with pytest.raises(InputError, match="leave out --masks"):
        perceive_views(both, PerceiveSettings(beside=SourceFiles(masks="m.png")), poses=poses)
    with pytest.raises(InputError, match="must hold 3 poses"):
        perceive_views([*both, both[0]], poses=poses)
    with pytest.raises(InputError, match="would be overwritten"):
        perceive_views(both, poses=poses, dot=poses)
