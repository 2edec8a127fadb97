"""Convex outlines: beside a twin that tests every side of Qhull's polygon."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from lifelore.perception.segmentation.outline import convex_corners, over_outline


def twin(points, table):
    inside = np.ones(len(points), bool)
    for x, y, offset in ConvexHull(table).equations:
        inside &= points[:, 0] * x + points[:, 1] * y + offset <= 0.0
    return inside


@pytest.mark.parametrize("n", [3, 10, 5000])
@pytest.mark.parametrize("draw", ["normal", "uniform"])
def test_over_the_outline_of_many_points(n, draw):
    rng = np.random.default_rng(n)
    table, asked = getattr(rng, draw)(size=(n, 2)), rng.uniform(-4, 4, (4000, 2))
    found = over_outline(asked, table)
    assert (found == twin(asked, table)).all()
    assert 0 < found.sum() < len(found)


def test_corners_belong_to_the_outline():
    square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    asked = np.array([[0.5, 0.5], [1.1, 0.5], [0.2, -0.1], [0, 1], [1, 0.3]])
    assert over_outline(asked, square).tolist() == [True, False, False, True, True]


def test_a_line_has_no_outline():
    line = np.array([[0.0, 0], [1, 0], [2, 0]])
    assert convex_corners(line) is None
    assert over_outline(np.array([[5.0, 5]]), line).all()


def test_a_margin_moves_every_side_of_a_square_by_it():
    square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    asked = np.array([[0.5, 1.099], [1.099, 0.2], [-0.099, 0.5], [0.5, 1.101], [1.101, 0.2], [1.1, 1.1]])
    assert over_outline(asked, square, 0.1).tolist() == [True, True, True, False, False, False]
