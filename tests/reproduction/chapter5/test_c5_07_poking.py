"""C5.7: scenes are what they are called, a scene is poked, and measures by hand."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.streams import stream
from reproduction.chapter5.c5_07_poking.run import drawn_scene, first_view, measures_of, outcome, poke_scene

pytest.importorskip("mujoco", reason="needs the extra sim")


def test_a_block_behind_another_is_one_segment_and_flush_blocks_are_one_too():
    scene = drawn_scene("occluded", 7, 0)
    truth, segments = scene.cloud.labels, first_view(scene).labels
    own = [int(np.bincount(truth[segments == s]).argmax()) for s in np.unique(segments) if s > TABLE]
    assert sorted(own.count(label) for label in set(own)) == [1, 1, 1]
    scene = drawn_scene("flush", 7, 0)
    assert (np.unique(first_view(scene).labels) > TABLE).sum() < len(scene.shapes)


def test_a_scene_is_poked():
    scene = drawn_scene("flush", 7, 0)
    before, after = poke_scene(scene, stream(7, "test"), 1)
    assert (before == first_view(scene).labels).all()
    assert len(outcome(scene.cloud.labels, before, after)) == len(scene.shapes)


def test_an_outcome_by_hand():
    truth, before = np.array([2, 2, 3, 3, 4, 4]), np.array([2, 2, 2, 2, 3, 4])
    assert outcome(truth, before, truth) == [[2, 0.5, 1.0], [2, 0.5, 1.0], [2, 0.5, 1.0]]


def test_measures_by_hand():
    scenes = [[[10, 0.4, 0.8], [30, 0.6, 0.6]], [[20, 0.9, 0.4]]]
    found = {name: number.value for name, number in measures_of(scenes).items()}
    assert found["overlap_gain"] == pytest.approx((4 + 0 - 10) / 60)
    assert found["found_before"] == found["found_after"] == pytest.approx(2 / 3)
    assert (found["found_gain"], found["corrected"], found["spoiled"]) == (0.0, 1.0, 0.5)
