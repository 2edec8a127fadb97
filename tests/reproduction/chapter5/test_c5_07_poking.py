"""C5.7: scenes are what they are called, measures by hand, and pictures survive packing."""

import json

import numpy as np
import pytest

from lifelore.core.streams import stream
from lifelore.perception.segmentation.poking import PokedLabels
from reproduction.chapter2.scoring.segmentation_scoring import overlaps
from reproduction.chapter5.c5_07_poking.measure import measures_of, rows
from reproduction.chapter5.c5_07_poking.run import (
    KINDS,
    Trial,
    drawn_scene,
    example,
    first_view,
    outcome,
    owners,
    poke_scene,
    still_scene,
    unpacked,
)

pytest.importorskip("mujoco", reason="needs the extra sim")


def test_occluded_blocks_are_seen_in_two_parts_and_flush_blocks_in_one_segment():
    scene = drawn_scene("occluded", 7, 0)
    own = list(owners(scene.cloud.labels, first_view(scene).labels).values())
    assert sorted(own.count(label) for label in set(own)) == [1, 1, 2]
    scene = drawn_scene("flush", 7, 0)
    assert len(owners(scene.cloud.labels, first_view(scene).labels)) < len(scene.shapes)


def test_a_scene_is_poked_and_the_control_is_not():
    scene = drawn_scene("flush", 7, 0)
    trial = poke_scene(scene, stream(7, "test"), 1)
    still = still_scene(scene, stream(7, "test still"))
    assert trial.pokes >= 1
    assert still.pokes == 0
    found = outcome(scene.cloud.labels, trial, still)
    assert found["still"] == 0
    assert len(found["objects"]) == len(overlaps(scene.cloud.labels, trial.before)) == len(scene.shapes)
    truth, clouds = unpacked(json.loads(json.dumps(example("flush", scene, trial))))
    assert set(np.unique(truth)) <= set(np.unique(scene.cloud.labels))
    assert [len(cloud.points) for cloud in clouds] == [len(truth)] * 3


def labelled(after, merged=(), split=()):
    return PokedLabels(np.array(after), {}, merged, split)


def test_an_outcome_by_hand():
    truth, before = np.array([2, 2, 3, 3, 4, 4]), np.array([2, 2, 2, 2, 3, 4])
    trial = Trial(before, labelled([2, 2, 3, 3, 4, 4], ((3, 4),), (2,)), 5)
    found = outcome(truth, trial, Trial(before, labelled(before), 0))
    assert found["objects"] == [[2, 0.5, 1.0], [2, 0.5, 1.0], [2, 0.5, 1.0]]
    assert (found["merges"], found["splits"], found["still"]) == ([1, 1], [1, 1], 0)
    wrong = Trial(before, labelled([2, 3, 4, 4, 4, 4], ((2, 3),), (2,)), 5)
    found = outcome(truth, wrong, Trial(before, labelled(before, ((3, 4),)), 0))
    # The parts of the split segment belong to objects 2, 2 and 3; segments 2 and 3 to objects 2 and 4.
    assert (found["merges"], found["splits"], found["still"]) == ([0, 1], [0, 1], 1)


def test_measures_by_hand():
    scene = {"pokes": 4, "segments": 2, "merges": [1, 1], "splits": [0, 1], "still": 0}
    first = {**scene, "kind": "flush", "objects": [[10, 0.4, 0.8], [30, 0.6, 0.6]]}
    second = {**scene, "kind": "flush", "objects": [[20, 0.9, 0.4]], "splits": [0, 0]}
    found = {name: number.value for name, number in measures_of([first, second]).items()}
    assert found["overlap_before"] == pytest.approx((4 + 18 + 18) / 60)
    assert found["overlap_gain"] == pytest.approx((4 + 0 - 10) / 60)
    assert found["found_before"] == found["found_after"] == pytest.approx(2 / 3)
    assert (found["corrected"], found["spoiled"]) == (1.0, 0.5)
    assert (found["merges_right"], found["splits_right"], found["changed_unpoked"]) == (1.0, 0.0, 0.0)


def test_a_changed_scene_is_drawn_rather_than_the_first():
    pictures = [{"example": KINDS[0], "changed": changed} for changed in (False, True, True)]
    pictures[2]["late"] = True
    assert rows({}, [{"scenes": [], "examples": pictures}]) == [pictures[1]]
