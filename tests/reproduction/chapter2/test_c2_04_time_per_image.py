"""C2.4: what is timed and what is not, and the numbers by hand; no time is asserted."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from reproduction.chapter2.c2_04_time_per_image import run as image_timing
from reproduction.chapter2.c2_04_time_per_image.measure import measure, rows
from reproduction.chapter2.c2_04_time_per_image.run import DENSE, KINDS, made_dense, run_cell, timed_image
from reproduction.chapter2.c2_04_time_per_image.run import cells as timing_cells
from reproduction.chapter2.scoring.perception_stages import STAGES
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C2.4")
FULL = dict(claim_of("C2.4").sizes["full"])
QUICK = dict(claim_of("C2.4").sizes["quick"])


def image(kind, seconds, points=100):
    """A picture whose stages took equally long."""
    found = {
        "kind": kind, "points": points, "points_of_things": points // 2, "processor_seconds": seconds / 2,
        "seconds": [seconds / len(STAGES)] * len(STAGES),
    }  # fmt: skip
    return found if kind == DENSE else {**found, "segmentation": 0.01}


def results(stereo):
    images = [image("stereo", seconds) for seconds in stereo]
    images += [image(kind, seconds) for kind in KINDS[1:] for seconds in (0.2, 0.3, 0.1)]
    return [{"processor": "one", "images": images[:2]}, {"processor": "one", "images": images[2:]}]


def test_measures_by_hand():
    found = measure(QUICK, results([0.1, 0.2, 0.3, 0.6]))
    assert found["seconds_stereo"].value == pytest.approx(0.3)
    assert found["seconds_stereo"].median == pytest.approx(0.25)
    assert found["seconds_stereo_95_percent"].value == pytest.approx(0.3 + 0.85 * 0.3)
    assert (found["points_kinect"].value, found["points_kinect"].n) == (100, 3)
    # Of the three kinds the interval of the stereo pictures reaches beyond half a second.
    assert (found["seconds_of_kinds_well_under_one"].value, found["seconds_of_kinds_well_under_one"].n) == (
        pytest.approx(1 if found["seconds_stereo"].ci95[1] <= 0.5 else 2 / 3),
        3,
    )
    assert found["seconds_stereo_dense"].value == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("stereo", "verdict"),
    [
        ([0.1, 0.2, 0.3, 0.2], "holds"),
        ([0.7, 0.8, 0.75, 0.8], "holds in part"),
        ([1.7, 1.8, 1.75, 1.8], "does not hold"),
    ],
)
def test_verdicts(stereo, verdict):
    found = {name: number.to_dict() for name, number in measure(QUICK, results(stereo)).items()}
    assert CLAIM.predicate.verdict(found) == verdict


def test_rows_hold_the_median_of_each_stage():
    found = rows(QUICK, results([0.7, 1.4, 2.1]))
    stages = [line for line in found if line.get("stage") and line["images"] == "stereo"]
    assert [line["stage"] for line in stages] == list(STAGES)
    assert {line["median_ms"] for line in stages} == {200.0}
    (stereo,) = [line for line in found if line.get("images") == "stereo" and "seconds" in line]
    assert stereo["seconds"] == [0.7, 1.4, 2.1]
    assert stereo["seconds_of_processor_a_second"]["value"] == pytest.approx(0.5)
    assert stereo["points_of_things"]["value"] == 50
    assert stereo["seconds_of_segmentation"]["value"] == 0.01
    assert found[-1] == {"processors": ["one"]}


def test_cells_are_lots_of_every_camera():
    cells = timing_cells({"images": 12})
    assert cells == [{"camera": c, "first": first} for c in ("stereo", "kinect") for first in (0, 11)]
    assert len(timing_cells(FULL)) == 24


def test_of_the_repeats_the_one_in_the_middle_counts(monkeypatch):
    takes = iter([0.3, 0.1, 0.2])
    monkeypatch.setattr(image_timing, "timed_stages", lambda cloud, model: dict.fromkeys(STAGES, next(takes)))
    cloud = LabelledCloud(np.zeros((3, 3)), np.array([TABLE, 2, 3]))
    found = timed_image(cloud, None, 3)  # type: ignore[arg-type]
    assert found["seconds"] == [0.2] * len(STAGES)
    assert (found["points"], found["points_of_things"]) == (3, 2)


def test_a_dense_cloud_has_more_points_of_things_and_the_same_table():
    points = np.random.default_rng(0).uniform(0, 0.1, (30, 3))
    labels = np.repeat([TABLE, 2, 3], [10, 15, 5])
    dense = made_dense(LabelledCloud(points, labels), 70, np.random.default_rng(1))
    assert np.bincount(dense.labels).tolist() == [0, 10, 60, 20]
    np.testing.assert_array_equal(dense.of(TABLE), points[:10])
    assert 0 < np.abs(dense.of(2) - np.repeat(points[10:25], 4, axis=0)).max() < 0.005


def test_a_cell_times_every_picture_after_a_warm_up(monkeypatch):
    pytest.importorskip("mujoco")
    seen = []

    def stages(cloud, model):
        seen.append(len(cloud.points))
        return dict.fromkeys(STAGES, 0.01)

    monkeypatch.setattr(image_timing, "timed_stages", stages)
    settings = {"images": 2, "repeats": 1, "dense_points": 50_000, "dense_every": 2}
    found = run_cell(settings, {"camera": "stereo", "first": 0}, 0)
    assert [one["kind"] for one in found["images"]] == ["stereo", DENSE, "stereo"]
    assert seen == [found["images"][0]["points"], *(one["points"] for one in found["images"])]
    assert found["images"][1]["points_of_things"] >= 50_000
