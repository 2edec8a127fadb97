"""Things side by side: gaps against a brute force over the footprints' points."""

import numpy as np
import pytest

from lifelore.domains.tabletop.layout import CLEARANCE, put_beside, separation, stand, top
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.shapes import box


def test_standing_things_are_just_above_their_height():
    thing = stand(box(0.2, 0.1, 0.06), about(0, np.pi / 2), height=0.3)
    assert thing.outline()[:, 2].min() == pytest.approx(0.3 + CLEARANCE)
    assert top([thing]) == pytest.approx(0.4 + CLEARANCE)


@pytest.mark.parametrize("direction", [0.0, 0.4, 2.0, 4.5])
def test_boxes_beside_one_another_have_the_gap(direction):
    still = [stand(box(0.2, 0.1, 0.1))]
    moving = put_beside(still, [stand(box(0.1, 0.1, 0.1), about(2, 0.3))], direction, 0.025)
    grids = [_dense(thing) for thing in (still[0], moving[0])]
    nearest = min(float(np.linalg.norm(grids[1] - point, axis=1).min()) for point in grids[0])
    # A quarter of a degree over 0.2 m is 0.9 mm; the grid adds one of its half steps.
    assert nearest == pytest.approx(0.025, abs=0.0015)
    assert separation(still, moving) == pytest.approx(0.025)


def _dense(thing):
    """Points over the rim of a box's footprint."""
    signs = np.array([[1, 1, 0], [1, -1, 0], [-1, -1, 0], [-1, 1, 0]])
    corners = thing.pose.apply(signs * thing.shape.parts[0].size)[:, :2]
    return np.concatenate(
        [np.linspace(a, b, 300) for a, b in zip(corners, np.roll(corners, 1, axis=0), strict=True)]
    )
