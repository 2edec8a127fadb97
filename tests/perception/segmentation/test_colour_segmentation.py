"""The thesis's colour method on colours chosen by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.segmentation.colour_segmentation import colour_classes, normalised

RED, BLUE, GREEN = (200, 20, 20), (20, 30, 220), (30, 200, 40)


def blobs(*parts):
    """Each part is (centre, n, colour): a ball of points, its colours darkened at random as a light would."""
    rng = np.random.default_rng(1)
    points = np.concatenate([rng.normal(0, 0.01, (n, 3)) + centre for centre, n, _ in parts])
    colours = np.concatenate([np.array(colour) * rng.uniform(0.3, 1, (n, 1)) for _, n, colour in parts])
    return points, colours.astype(np.uint8), np.repeat(np.arange(len(parts)), [n for _, n, _ in parts])


def test_brightness_is_divided_away():
    shares = normalised(np.array([[100, 50, 50], [200, 100, 100], [0, 0, 0]], np.uint8))
    np.testing.assert_allclose(shares, [[0.5, 0.25, 0.25], [0.5, 0.25, 0.25], [1 / 3, 1 / 3, 1 / 3]])


def test_three_colours_are_two_objects_and_the_smallest_is_background():
    points, colours, part = blobs(((0, 0, 0), 500, RED), ((0.2, 0, 0), 800, BLUE), ((0.1, 0.3, 0), 100, GREEN))
    labels = colour_classes(points, colours)
    assert [set(labels[part == k]) for k in range(3)] == [{3}, {2}, {0}]


def test_with_more_clusters_a_size_decides():
    points, colours, part = blobs(
        ((0, 0, 0), 500, RED),
        ((0.2, 0, 0), 800, BLUE),
        ((0, 0.2, 0), 300, GREEN),
        ((0.2, 0.2, 0), 40, (120, 120, 120)),
    )
    labels = colour_classes(points, colours, k=4)
    assert [set(labels[part == k]) for k in range(4)] == [{3}, {2}, {4}, {0}]


def test_a_spot_of_another_colour_is_cleaned_up_by_its_neighbours():
    points, colours, part = blobs(((0, 0, 0), 500, RED), ((0.2, 0, 0), 800, BLUE), ((0.1, 0.3, 0), 100, GREEN))
    spots = np.flatnonzero(part == 0)[::25]
    colours[spots] = BLUE
    assert set(colour_classes(points, colours, neighbours=1)[spots]) == {2}
    assert set(colour_classes(points, colours)[spots]) == {3}


def test_the_same_points_give_the_same_labels():
    points, colours, _ = blobs(((0, 0, 0), 300, RED), ((0.1, 0, 0), 300, GREEN), ((0, 0.1, 0), 300, BLUE))
    assert colour_classes(points, colours).tolist() == colour_classes(points, colours).tolist()


def test_fewer_colours_than_asked_for_are_refused():
    with pytest.raises(InputError, match="show 1 colours where 3"):
        colour_classes(np.zeros((9, 3)), np.full((9, 3), 90, np.uint8))
    assert len(colour_classes(np.empty((0, 3)), np.empty((0, 3), np.uint8))) == 0
