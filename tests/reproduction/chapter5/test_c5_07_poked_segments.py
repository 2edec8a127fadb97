"""Pushes merge and split segments of boxes whose clouds are cast ray by ray, without physics."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from reproduction.chapter5.c5_07_poking.poked_patches import Poke, largest_step, turned_about
from reproduction.chapter5.c5_07_poking.poked_segments import PokedSegments
from tests.perception.segmentation.boards import Board, cast_boards

CAMERA = np.array([0.0, -0.7, 0.6])
PUSH, BACK = np.array([0.025, 0.0, 0.0]), np.array([0.0, 0.025, 0.0])


def picture(boxes, seed=0):
    """What the camera sees of boxes ``(x, y, half sizes)`` on the table; label k + 2 for box k."""
    rng = np.random.default_rng(seed)
    u, v = np.meshgrid(np.arange(-0.32, 0.32, 0.004), np.arange(-0.32, 0.32, 0.004))
    ahead = np.array([0.0, 0.75, -0.66])
    up = np.cross([1.0, 0.0, 0.0], ahead)
    rays = ahead + u.reshape(-1, 1) * [1.0, 0.0, 0.0] + v.reshape(-1, 1) * up
    boards = [Board("box", (x, y, half[2]), half) for x, y, half in boxes]
    number, along, _ = cast_boards(boards, CAMERA, rays)
    floor = np.where(rays[:, 2] < 0, -CAMERA[2] / np.minimum(rays[:, 2], -1e-9), np.inf)
    labels = np.where(floor < along, TABLE, number + 2)
    along = np.minimum(along, floor)
    seen = np.isfinite(along) & (along < 2.5)
    noisy = along[seen] * (1 + rng.normal(0, 0.001, np.count_nonzero(seen)))
    return LabelledCloud(CAMERA + rays[seen] * noisy[:, None], labels[seen], None, CAMERA)


def as_one(cloud, *labels):
    """The cloud with some labels joined into the first."""
    return LabelledCloud(
        cloud.points, np.where(np.isin(cloud.labels, labels), labels[0], cloud.labels), None, CAMERA
    )


BLOCK = (0.05, 0.05, 0.04)
PAIR = [(-0.051, 0.0, BLOCK), (0.051, 0.0, BLOCK)]
LEFT, RIGHT = np.array([-0.05, -0.05, 0.03]), np.array([0.05, -0.05, 0.03])


def moved(boxes, *which, by=PUSH):
    return [(x + by[0] * (k in which), y + by[1] * (k in which), half) for k, (x, y, half) in enumerate(boxes)]


def labels_of_blocks(known, first):
    """The most frequent label of each block after the pushes, and the least share of it in a block."""
    found = known.corrected()
    parts = [found[first.labels == label] for label in (2, 3)]
    own = [int(np.bincount(part).argmax()) for part in parts]
    return own, min((part == label).mean() for part, label in zip(parts, own, strict=True))


def test_flush_blocks_in_one_segment_split_when_one_moves():
    first = picture(PAIR)
    known = PokedSegments(as_one(first, 2, 3))
    known.observe(Poke(RIGHT, PUSH), picture(moved(PAIR, 1), 1))
    own, share = labels_of_blocks(known, first)
    assert own[0] != own[1]
    assert share > 0.85


def test_two_segments_merge_when_a_push_on_each_moves_both():
    first = picture(PAIR)
    known = PokedSegments(first)
    known.observe(Poke(LEFT, BACK), picture(moved(PAIR, 0, 1, by=BACK), 1))
    assert len(set(labels_of_blocks(known, first)[0])) == 2
    known.observe(Poke(RIGHT, BACK), picture(moved(PAIR, 0, 1, by=2 * BACK), 2))
    assert len(set(labels_of_blocks(known, first)[0])) == 1


def test_a_motion_that_rest_explains_as_well_tells_nothing():
    # Along their row, the left block takes the place that the right block leaves.
    first = picture(PAIR)
    known = PokedSegments(first)
    for poke, steps in ((LEFT, 1), (RIGHT, 2)):
        known.observe(Poke(poke, PUSH), picture(moved(PAIR, 0, 1, by=steps * PUSH), steps))
    assert len(set(labels_of_blocks(known, first)[0])) == 2


def test_pictures_without_a_motion_change_nothing():
    first = picture(PAIR)
    known = PokedSegments(as_one(first, 2, 3))
    for seed in (1, 2):
        assert (known.observe(Poke(LEFT, PUSH), picture(PAIR, seed)) <= 0).all()
    assert np.unique(known.corrected()).tolist() == [TABLE, 2]


def test_a_push_goes_against_a_steep_side():
    known = PokedSegments(picture(PAIR))
    poke = known.poke_at(2, np.random.default_rng(0), 0.025)
    assert np.linalg.norm(poke.push) == pytest.approx(0.025)
    assert poke.push[2] == pytest.approx(0.0, abs=1e-9)
    assert poke.push[1] > 0.02  # the front is the only steep side that the camera sees well
    assert known.poke_at(9, np.random.default_rng(0), 0.025) is None


def test_a_cloud_may_be_empty():
    empty = PokedSegments(LabelledCloud(np.zeros((1, 3)), np.array([TABLE]), None, CAMERA))
    assert empty.corrected().tolist() == [TABLE]


def test_a_turn_about_a_point_and_its_largest_step_by_hand():
    quarter = turned_about(np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, np.pi / 2]), np.array([0.0, 0.0, 1.0]))
    assert quarter @ [0, 0, 0, 1] == pytest.approx([1.0, -1.0, 1.0, 1.0])
    assert largest_step(quarter, np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])) == pytest.approx(np.sqrt(3))
