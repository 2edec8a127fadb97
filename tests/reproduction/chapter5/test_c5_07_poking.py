"""C5.7: scenes are what they are called, measures by hand, and pictures survive packing."""

import json

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.streams import stream
from lifelore.perception.segmentation.poking import PokedLabels
from reproduction.chapter2.scoring.segmentation_scoring import overlaps
from reproduction.chapter5.c5_07_poking.run import (
    KINDS,
    Trial,
    drawn_scene,
    example,
    first_view,
    measures_of,
    outcome,
    poke_scene,
    rows,
    unpacked,
)

pytest.importorskip("mujoco", reason="needs the extra sim")


def test_occluded_blocks_are_seen_in_two_parts_and_flush_blocks_in_one_segment():
    scene = drawn_scene("occluded", 7, 0)
    truth, segments = scene.cloud.labels, first_view(scene).labels
    own = [int(np.bincount(truth[segments == s]).argmax()) for s in np.unique(segments) if s > TABLE]
    assert sorted(own.count(label) for label in set(own)) == [1, 1, 2]
    scene = drawn_scene("flush", 7, 0)
    assert (np.unique(first_view(scene).labels) > TABLE).sum() < len(scene.shapes)


def test_a_scene_is_poked():
    scene = drawn_scene("flush", 7, 0)
    trial = poke_scene(scene, stream(7, "test"), 1)
    assert trial.pokes >= 1
    assert (
        len(outcome(scene.cloud.labels, trial))
        == len(overlaps(scene.cloud.labels, trial.before))
        == len(scene.shapes)
    )
    truth, clouds = unpacked(json.loads(json.dumps(example("flush", scene, trial))))
    assert set(np.unique(truth)) <= set(np.unique(scene.cloud.labels))
    assert [len(cloud.points) for cloud in clouds] == [len(truth)] * 3


def test_an_outcome_by_hand():
    truth, before = np.array([2, 2, 3, 3, 4, 4]), np.array([2, 2, 2, 2, 3, 4])
    after = PokedLabels(np.array([2, 2, 3, 3, 4, 4]), {}, ((3, 4),), (2,))
    assert outcome(truth, Trial(before, after, 5)) == [[2, 0.5, 1.0], [2, 0.5, 1.0], [2, 0.5, 1.0]]


def test_measures_by_hand():
    scenes = [{"objects": [[10, 0.4, 0.8], [30, 0.6, 0.6]]}, {"objects": [[20, 0.9, 0.4]]}]
    found = {name: number.value for name, number in measures_of(scenes).items()}
    assert found["overlap_gain"] == pytest.approx((4 + 0 - 10) / 60)
    assert found["found_before"] == found["found_after"] == pytest.approx(2 / 3)
    assert (found["found_gain"], found["corrected"], found["spoiled"]) == (0.0, 1.0, 0.5)


def test_a_changed_scene_is_drawn_rather_than_the_first():
    pictures = [{"example": KINDS[0], "changed": changed} for changed in (False, True, True)]
    pictures[2]["late"] = True
    assert rows({}, [{"examples": pictures}]) == [pictures[1]]
