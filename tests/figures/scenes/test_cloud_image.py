"""What is nearer hides what is farther; objects have their colours, nothing else has."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.figures.scenes import cloud_image
from lifelore.figures.scenes.camera_projection import camera_of
from lifelore.figures.scenes.cloud_image import render_cloud
from lifelore.figures.scenes.object_palette import object_palette, rgb

SIZE = (160, 120)


def wall(y, x=(0, 1), z=(0, 1), n=40):
    across, up = np.meshgrid(np.linspace(*x, n), np.linspace(*z, n))
    return np.column_stack([across.ravel(), np.full(n * n, float(y)), up.ravel()])


def scene(*walls, labels, colours=None):
    points = np.vstack(walls)
    numbers = np.repeat(labels, [len(w) for w in walls])
    return LabelledCloud(points, numbers, colours, np.array([0.5, -3.0, 0.5]))


def seen(cloud, size=SIZE):
    camera = camera_of(cloud, size)
    return render_cloud(cloud, camera, object_palette(cloud.objects)), camera


def labels_at(image, camera, points):
    column, row = camera.project(points)[0].astype(int).T
    return image.labels[row, column].tolist()


def test_the_nearer_wall_hides_the_farther():
    near, far = wall(0, x=(0, 0.5)), wall(1, x=(0, 1.5))
    for order in ((near, far), (far, near)):
        labels = [2, 3] if order[0] is near else [3, 2]
        image, camera = seen(scene(*order, labels=labels))
        assert labels_at(image, camera, [[0.25, 0, 0.5], [1.2, 1, 0.5]]) == [2, 3]


def test_surfaces_close_and_the_rest_is_paper():
    image, camera = seen(scene(wall(0), labels=[2]))
    (left, top), (right, bottom) = camera.project([[0.02, 0, 0.98], [0.98, 0, 0.02]])[0].astype(int)
    assert (image.labels[top:bottom, left:right] == 2).all()
    assert image.labels[0, 0] == -1
    np.testing.assert_allclose(image.colours[0, 0], 1)


def test_an_object_is_its_colour_and_the_table_grey():
    image, camera = seen(scene(wall(0, x=(0, 0.5)), wall(0, x=(0.55, 1)), wall(0, x=(1.1, 1.6)), labels=[2, 3, 1]))
    for x, number in ((0.25, 2), (0.8, 3)):
        column, row = camera.project([[x, 0, 0.5]])[0][0].astype(int)
        colour, wanted = image.colours[row, column], rgb(object_palette([2, 3])[number])
        assert np.argmax(colour) == np.argmax(wanted)
        assert np.corrcoef(colour, wanted)[0, 1] > 0.95
    grey = image.colours[image.labels == 1]
    assert len(grey) == 0 or np.ptp(grey, axis=1).max() < 0.2


def test_light_falls_from_above():
    floor = wall(0)[:, [0, 2, 1]] + [0, 0, 1]
    front = wall(0)
    points = np.vstack([floor, front])
    cloud = LabelledCloud(points, np.full(len(points), 2), None, np.array([0.5, -3.0, 3.0]))
    image, camera = seen(cloud)
    (a, b), (c, d) = camera.project([[0.5, 0.5, 1], [0.5, 0, 0.5]])[0].astype(int)
    assert image.colours[b, a].sum() > image.colours[d, c].sum() + 0.2


def test_large_clouds_are_thinned_and_drawn_the_same_each_time(monkeypatch):
    monkeypatch.setattr(cloud_image, "_MOST_POINTS", 500)
    cloud = scene(wall(0), labels=[2])
    (one, _), (two, _) = seen(cloud), seen(cloud)
    np.testing.assert_array_equal(one.colours, two.colours)
    assert (one.labels == 2).mean() > 0.3


@pytest.mark.parametrize("n", [0, 1, 5])
def test_few_points_are_drawn(n):
    points = np.random.default_rng(0).uniform(0, 1, (n, 3))
    image, _ = seen(LabelledCloud(points, np.full(n, 2)))
    assert np.isfinite(image.colours).all()
    assert (image.labels == 2).any() == (n > 0)


def test_colours_of_the_points_show_as_light_and_dark():
    colours = np.repeat(np.array([[20, 20, 20], [235, 235, 235]], np.uint8), 1600, axis=0)
    image, camera = seen(scene(wall(0, x=(0, 0.5)), wall(0, x=(0.5, 1)), labels=[2, 2], colours=colours))
    (a, b), (c, d) = camera.project([[0.2, 0, 0.5], [0.8, 0, 0.5]])[0].astype(int)
    assert image.colours[b, a].sum() < image.colours[d, c].sum()
