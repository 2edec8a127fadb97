"""The picture is taken from the cloud's camera, shows all objects, and is right way up."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.figures.scenes.camera_projection import camera_of

SIZE = (400, 300)


def cloud_of(points, labels=None, camera=None):
    points = np.asarray(points, float)
    labels = np.full(len(points), 2) if labels is None else np.asarray(labels)
    return LabelledCloud(points, labels, None, None if camera is None else np.asarray(camera, float))


def test_projection_by_hand():
    # From (0, -2, 0) towards +y: x right, z up; the nearer of two equal heights is the higher in the picture.
    points = [[-1, 0, -1], [1, 0, 1], [1, 0, -1], [-1, 0, 1]]
    camera = camera_of(cloud_of(points, camera=[0, -2, 0]), (100, 100))
    pixels, depth = camera.project(points)
    np.testing.assert_allclose(depth, 2)
    # The square fills the picture but for a margin of a tenth of itself: 100 / 1.2 pixels wide.
    low, high = 50 - 50 / 1.2, 50 + 50 / 1.2
    np.testing.assert_allclose(pixels, [[low, high], [high, low], [high, high], [low, low]], atol=1e-9)


@given(
    place=st.tuples(*[st.floats(-1, 1)] * 3), distance=st.floats(0.8, 5),
    turn=st.floats(0, 6.28), tilt=st.floats(-0.5, 1.3), seed=st.integers(0, 99),
)  # fmt: skip
@settings(deadline=None, max_examples=60)
def test_all_objects_are_shown_right_way_up(place, distance, turn, tilt, seed):
    points = np.array(place) + np.random.default_rng(seed).uniform(-0.2, 0.2, (30, 3))
    towards = np.array([np.cos(turn) * np.cos(tilt), np.sin(turn) * np.cos(tilt), np.sin(tilt)])
    cloud = cloud_of(points, camera=points.mean(axis=0) + distance * towards)
    camera = camera_of(cloud, SIZE)
    np.testing.assert_allclose(camera.axes @ camera.axes.T, np.eye(3), atol=1e-9)
    pixels, depth = camera.project(points)
    assert (depth > 0).all()
    assert (pixels >= 0).all()
    assert (pixels <= SIZE).all()
    middle = points.mean(axis=0)
    foot, head = camera.project([middle, middle + np.array([0, 0, 0.01])])[0]
    assert head[1] <= foot[1] + 1e-6


def test_the_table_is_shown_as_far_as_the_objects_reach():
    table = np.random.default_rng(0).uniform(-3, 3, (50, 3)) * [1, 1, 0]
    box = np.random.default_rng(1).uniform(0, 0.1, (50, 3))
    cloud = cloud_of(np.vstack([table, box]), [1] * 50 + [2] * 50, [0, -1, 1])
    pixels, _ = camera_of(cloud, SIZE).project(box)
    assert np.ptp(pixels, axis=0).max() > 200


def test_without_camera_it_looks_down_from_the_front_right():
    camera = camera_of(cloud_of(np.random.default_rng(0).uniform(0, 1, (20, 3))), SIZE)
    assert (camera.axes[2] * [-1, 1, -1] > 0).all()


def test_what_is_behind_the_camera_is_nowhere():
    camera = camera_of(cloud_of([[0, 0, 0], [0.1, 0, 0]], camera=[0, -1, 0]), SIZE)
    pixels, depth = camera.project([[0, -2, 0]])
    assert np.isnan(pixels).all()
    assert np.isnan(depth).all()


def test_empty_and_single_points_have_a_view():
    for points in (np.empty((0, 3)), np.zeros((1, 3))):
        for position in (None, [0, 0, 1.0], [0, 0, 0.0]):
            camera = camera_of(cloud_of(points, camera=position), SIZE)
            assert np.isfinite(camera.project([[0, 0, 0]])[0]).all()
