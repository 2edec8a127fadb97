"""Poses against matrices worked by hand and properties of rotations."""

import numpy as np
import pytest

from lifelore.domains.tabletop.pose import Pose, about, aligned, random_rotation


def test_a_pose_turns_then_moves():
    pose = Pose(np.array([1.0, 0.0, 2.0]), about(2, np.pi / 2))
    assert pose.apply(np.array([[1.0, 0.0, 0.5]])) == pytest.approx(np.array([[1.0, 1.0, 2.5]]))


def test_random_and_aligned_rotations_are_rotations():
    rng = np.random.default_rng(0)
    for _ in range(50):
        for turn in (random_rotation(rng), aligned(rng.normal(size=3))):
            assert turn @ turn.T == pytest.approx(np.eye(3))
            assert np.linalg.det(turn) == pytest.approx(1)
    direction = np.array([3.0, -1.0, 2.0])
    assert aligned(direction)[:, 2] == pytest.approx(direction / np.linalg.norm(direction))
