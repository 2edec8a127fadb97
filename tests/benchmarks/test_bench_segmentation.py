"""`bench segmentation` on a scene made by hand: its rows, its goals, what is drawn, and what stays open."""

import numpy as np
import pytest

from benchmarks.perception import segmentation
from benchmarks.perception.segmentation_scenes import METHODS, TrueScene
from lifelore.app import bench_command
from lifelore.core.relations import PairLabel
from lifelore.figures.scenes.segmentation_panels import coloured_as
from lifelore.perception.clouds.point_cloud import PointCloud


def plate(x, y, z, length, width, step=0.003):
    flat = np.stack(np.meshgrid(np.arange(0, length, step), np.arange(0, width, step), [0.0]), axis=-1)
    return flat.reshape(-1, 3) + np.array([x, y, z])


def wall(x, y, z, length, height, step=0.003):
    upright = np.stack(np.meshgrid(np.arange(0, length, step), [0.0], np.arange(0, height, step)), axis=-1)
    return upright.reshape(-1, 3) + np.array([x, y, z])


def box_on_box(name: str) -> TrueScene:
    """A box on a larger box, seen from the front: their tops and fronts."""
    parts = [
        (1, plate(-0.3, -0.3, 0, 0.6, 0.6)),
        (2, np.concatenate([plate(-0.1, -0.1, 0.08, 0.2, 0.2), wall(-0.1, -0.1, 0, 0.2, 0.08)])),
        (3, np.concatenate([plate(-0.05, -0.05, 0.16, 0.1, 0.1), wall(-0.05, -0.05, 0.08, 0.1, 0.08)])),
    ]
    points = np.concatenate([part for _, part in parts])
    labels = np.repeat([label for label, _ in parts], [len(part) for _, part in parts])
    colours = np.random.default_rng(0).integers(0, 255, (len(points), 3)).astype(np.uint8)
    cloud = PointCloud(points, labels, colours, camera=np.array([0.1, -0.9, 0.6]))
    return TrueScene(name, cloud, (PairLabel(3, 2, "on", 3), PairLabel(2, 1, "on", 3)), "z")


@pytest.fixture
def by_hand(monkeypatch):
    monkeypatch.setattr(segmentation, "real_true_scenes", lambda: [box_on_box("first")])
    monkeypatch.setattr(segmentation, "simulated_true_scenes", lambda n: iter([box_on_box("second")] * n))
    monkeypatch.setattr(segmentation, "SCENES", 1)
    monkeypatch.setattr(segmentation, "DRAWN", ("first",))


@pytest.mark.slow
def test_rows_goals_and_picture(by_hand, tmp_path):
    told = []
    result = segmentation.bench_segmentation(1, lambda *at: told.append(at), tmp_path)
    value = {row["name"]: row["value"] for row in result["rows"]}
    for where in ("real", "simulated"):
        assert value[f"labels given, {where}, weighted overlap"] == 1
        assert value[f"convexity, {where}, found"] == 1
        assert value[f"convexity, {where}, weighted overlap"] > 0.85
        # The boxes touch, so that clusters merge them.
        assert value[f"distance clusters, {where}, found"] == 0.5
        assert value[f"distance clusters, {where}, relation recall"] == 0
        for method in METHODS:
            assert value[f"{method}, {where}, processor time, objects and relations"] > 0
    bands = [row for row in result["rows"] if "cut confidence" in row["name"] and row["name"].endswith("right")]
    assert sum(row["n"] for row in bands) == 4
    assert [goal["met"] for goal in result["goals"]].count(None) == 0
    assert "notes" not in result
    assert told[-1][:2] == (2, 2)
    assert 0 < (tmp_path / "segmentation.png").stat().st_size <= 300_000


@pytest.mark.slow
def test_without_real_scenes_the_goals_stay_open(by_hand, monkeypatch, tmp_path):
    monkeypatch.setattr(segmentation, "real_true_scenes", list)
    result = segmentation.bench_segmentation(1, lambda *at: None, tmp_path)
    assert {goal["met"] for goal in result["goals"]} == {None}
    assert not any(", real" in row["name"] for row in result["rows"])
    assert not list(tmp_path.iterdir())
    assert [note for note in result["notes"] if "LIFELORE_DATA" in note] == result["notes"] != []


def test_console_says_why_goals_on_real_scenes_stay_open(monkeypatch, capsys):
    goals = segmentation._goals({})
    document = {"bench": "segmentation", "rows": [], "goals": goals, "notes": [segmentation.NO_REAL_SCENES]}
    monkeypatch.setattr("benchmarks.bench", lambda *_, **__: document)
    bench_command.bench("segmentation", repeats=1)
    assert "real scenes, which need LIFELORE_DATA" in " ".join(capsys.readouterr().out.split())


def test_segments_are_coloured_as_the_objects_that_they_find():
    truth = np.array([1, 2, 2, 2, 3, 3, 3])
    labels = np.array([1, 3, 3, 4, 2, 2, 2])
    # Segment 3 finds object 2, segment 2 object 3; segment 4 is a further piece of object 2.
    assert coloured_as(truth, labels).tolist() == [1, 2, 2, 5, 3, 3, 3]
