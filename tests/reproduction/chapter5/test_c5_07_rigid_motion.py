"""Registration recovers known motions of a box's corner; motions compose."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from reproduction.chapter5.c5_07_poking.rigid_motion import STILL, registered, turned_about

SIDE = np.stack(np.meshgrid(np.arange(0, 0.1, 0.004), np.arange(0, 0.1, 0.004)), axis=-1).reshape(-1, 2)


def corner():
    """Three faces of a box that meet in a corner, and their normals."""
    points, normals = [], []
    for axis in range(3):
        points.append(np.insert(SIDE, axis, 0.1, axis=1))
        normals.append(np.tile(np.eye(3)[axis], (len(SIDE), 1)))
    return np.concatenate(points), np.concatenate(normals)


def test_a_known_motion_is_recovered():
    points, normals = corner()
    true = turned_about(points.mean(axis=0), np.array([0.0, 0.0, 0.1]), np.array([0.012, -0.007, 0.0]))
    surface, turned = true.apply(points), normals @ true.rotation.T
    found = registered(points, surface, turned, KDTree(surface), STILL, 0.03)
    assert np.abs(found.apply(points) - surface).max() < 0.002


def test_nothing_near_leaves_the_start():
    points, normals = corner()
    assert registered(points, points + 5.0, normals, KDTree(points + 5.0), STILL, 0.02) is STILL


def test_motions_compose_and_steps_are_measured_by_hand():
    quarter = turned_about(np.zeros(3), np.array([0.0, 0.0, np.pi / 2]), np.zeros(3))
    shift = turned_about(np.zeros(3), np.zeros(3), np.array([1.0, 0.0, 0.0]))
    point = np.array([[1.0, 0.0, 0.0]])
    assert quarter.after(shift).apply(point) == pytest.approx(np.array([[0.0, 2.0, 0.0]]))
    assert shift.after(quarter).apply(point) == pytest.approx(np.array([[1.0, 1.0, 0.0]]))
    assert shift.largest_step(point) == 1.0
