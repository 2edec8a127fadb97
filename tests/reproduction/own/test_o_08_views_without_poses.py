"""O8: distances to hulls, errors of poses and measures by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from reproduction.own.o_08_views_without_poses.run import distance_to_hull, error_of, measure


def test_distance_to_a_square_by_hand():
    square = np.array([[0.0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], [0, 0.1, 0]])
    assert distance_to_hull(np.array([0.05, 0.05, 0.03]), square) == pytest.approx(0.03, abs=1e-6)
    assert distance_to_hull(np.array([0.14, 0.13, 0.0]), square) == pytest.approx(0.05, abs=1e-6)
    assert distance_to_hull(np.array([0.02, 0.07, 0.0]), square) == pytest.approx(0.0, abs=1e-6)


def test_the_error_of_a_pose_is_taken_at_the_middle_of_the_objects():
    clean = np.array([[1.0, 0, 0], [1.0, 0, 0.2], [9.0, 9, 9]])
    photo = SimpleNamespace(clean=clean, cloud=SimpleNamespace(labels=np.array([2, 2, 1])))
    angle = np.radians(2.0)
    pose = np.eye(4)
    pose[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    turn, shift = error_of(pose, photo)  # type: ignore[arg-type]
    assert turn == pytest.approx(2.0)
    assert shift == pytest.approx(2 * np.sin(angle / 2))


def test_measures_by_hand():
    contacts = [
        {"one view": [True, False], "true poses": [True, True], "registered": [True, True]},
        {"one view": [False, False], "true poses": [True, False], "registered": [False, False]},
        {"one view": [], "true poses": [], "registered": []},
    ]
    result = {
        "pairs": [[20, 1.0, 0.002], [45, 6.0, 0.002], [45, None, None], [20, 1.0, 0.03]],
        "contacts": contacts,
    }
    found = measure({}, [result])
    assert (found["registered"].value, found["wrong"].value) == (0.75, 0.5)
    assert found["contacts_gained_registered"].value == 0.25
    assert found["contacts_gained_true_poses"].value == 0.5
