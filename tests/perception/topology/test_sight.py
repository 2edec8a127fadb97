"""Lines of sight: free, hidden, and not measured, by hand and against plain geometry."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import KDTree

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.perception.topology.sight import Sight

CAMERA = np.zeros(3)


def sight(points, camera=CAMERA, radius=0.01):
    points = np.array(points, float).reshape(-1, 3)
    return Sight(LabelledCloud(points, np.full(len(points), 2), camera=camera), radius)


def test_free_is_what_something_is_seen_behind():
    place = np.array([0, 1.0, 0])
    assert sight([[0, 2, 0]]).is_free(place)
    assert not sight([[0, 2, 0], [0, 0.5, 0.001]]).is_free(place)
    assert not sight([[0, 0.5, 0]]).is_free(place)
    assert not sight([[1, 2, 0]]).is_free(place)
    assert not sight([[0, 1.001, 0]]).is_free(place)


def test_what_any_camera_saw_through_is_free():
    place = np.array([0, 1.0, 0])
    points = np.array([[0, 0.5, 0], [0, 2.0, 0], [-2.0, 1, 0]])
    labels = np.full(3, 2)
    # The first camera sees (0, 0.5, 0) before the place; the second looks along -x and sees (-2, 1, 0) behind it.
    assert not Sight(LabelledCloud(points, labels, camera=CAMERA), 0.01).is_free(place)
    both = LabelledCloud(points, labels, camera=CAMERA, other_cameras=np.array([[3.0, 1, 0]]))
    assert Sight(both, 0.01).is_free(place)
    away = LabelledCloud(points, labels, camera=CAMERA, other_cameras=np.array([[0.0, 1, 3]]))
    assert not Sight(away, 0.01).is_free(place)


def test_without_a_camera_there_is_no_telling():
    assert sight([[0, 0.5, 0]], camera=None).is_free(np.array([0, 1.0, 0]))


coordinate = st.integers(-20, 20).map(lambda k: k / 10)


@pytest.mark.slow
@settings(deadline=None)
@given(
    st.lists(st.tuples(*[coordinate] * 3).filter(any), min_size=1, max_size=20),
    st.tuples(*[coordinate] * 3).filter(any),
)
def test_the_twin_agrees(points, place):
    place, radius = np.array(place), 0.15
    distance = np.linalg.norm(place)
    before = behind = False
    for point in np.array(points):
        depth = np.linalg.norm(point)
        apart = np.linalg.norm(point / depth - place / distance) * distance
        if abs(apart - radius) < 1e-9 or abs(abs(depth - distance) - radius) < 1e-9:
            return
        before |= bool(apart <= radius and depth < distance - radius)
        behind |= bool(apart <= radius and depth > distance + radius)
    assert sight(points, radius=radius).is_free(place) == (behind and not before)


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_a_search_among_directions_by_a_k_d_tree_agrees(seed):
    rng = np.random.default_rng(seed)
    points = rng.uniform(-1, 1, (200, 3)) + np.array([0, 2, 0])
    tree = KDTree(points / np.linalg.norm(points, axis=1)[:, None])
    depth = np.linalg.norm(points, axis=1)
    seen = sight(points, radius=0.1)
    for place in rng.uniform(-0.5, 0.5, (10, 3)) + np.array([0, 2, 0]):
        distance = np.linalg.norm(place)
        near = depth[tree.query_ball_point(place / distance, 0.1 / distance)]
        free = bool((near > distance + 0.1).any() and not (near < distance - 0.1).any())
        assert seen.is_free(place) == free
