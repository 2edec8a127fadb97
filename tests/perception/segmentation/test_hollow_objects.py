"""Inside and outside of hollow objects are one object; a box before a box, or two boards, are two."""

import numpy as np
import pytest

from lifelore.perception.segmentation.convexity_segmentation import convex_objects

CAMERA = np.array([0.0, -0.9, 0.7])
STEP = 0.002
LEAST = 6e-4


def mug(radius, height, floor=0.006):
    """The near half of the outside and the far half of the inside of a mug, and its floor as far as it is seen."""
    z = np.arange(0, height, STEP)
    half = np.arange(0, np.pi, STEP / radius)

    def wall(angles, r):
        ring = np.stack([np.cos(angles), np.sin(angles)], axis=1) * r
        return np.column_stack([np.tile(ring, (len(z), 1)), np.repeat(z, len(ring))])

    outside, inside = wall(-half, radius), wall(half, radius - 0.003)
    # The near rim hides the lower part of the inside.
    below_rim = (inside[:, 1] + radius) * 0.75
    return np.concatenate([outside, inside[inside[:, 2] > height - below_rim]])


def bowl(radius):
    """The near outside and the far inside of a hemisphere that stands open."""
    turn, rise = np.meshgrid(np.arange(0, np.pi, 0.02), np.arange(-1.2, 0, 0.02))
    turn, rise = turn.ravel(), rise.ravel()
    shell = np.stack([np.cos(turn) * np.cos(rise), np.sin(turn) * np.cos(rise), np.sin(rise)], axis=1)
    near = shell * (radius, -radius, radius) + np.array([0, 0, radius])
    far = shell * (radius - 0.003) + np.array([0, 0, radius])
    return np.concatenate([near, far])


def labels_of(*parts, seed=0):
    points = np.concatenate(parts)
    noisy = points + np.random.default_rng(seed).normal(0, 0.0007, points.shape)
    labels = convex_objects(noisy, CAMERA, LEAST).labels
    return np.split(labels, np.cumsum([len(part) for part in parts])[:-1])


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("shape", [mug(0.045, 0.09), mug(0.09, 0.10), bowl(0.08)], ids=["mug", "pot", "bowl"])
def test_both_sides_of_a_hollow_object_are_one(shape, seed):
    (labels,) = labels_of(shape, seed=seed)
    assert (labels == 2).mean() > 0.9


def test_two_mugs_beside_each_other_are_two():
    left, right = labels_of(mug(0.045, 0.09), mug(0.045, 0.09) + np.array([0.105, 0, 0]))
    assert np.bincount(left).argmax() != np.bincount(right).argmax()
    assert (left == np.bincount(left).argmax()).mean() > 0.85


def test_a_board_behind_a_board_of_the_same_height_is_another_object():
    x, z = (a.ravel() for a in np.meshgrid(np.arange(-0.08, 0.08, STEP), np.arange(0, 0.12, STEP)))
    near, far = np.column_stack([x, np.zeros_like(x), z]), np.column_stack([x, np.full_like(x, 0.06), z])
    first, second = labels_of(near, far[far[:, 2] > 0.07])
    assert np.bincount(first).argmax() != np.bincount(second).argmax()
