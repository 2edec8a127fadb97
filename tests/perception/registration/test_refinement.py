"""Refinement of a start beside the true motion."""

import numpy as np

from lifelore.perception.registration.refinement import refined_motion
from lifelore.perception.registration.start_search import turned


def test_a_start_two_degrees_and_eight_millimetres_off_is_mended(blocks_seen) -> None:
    view = blocks_seen()
    off = turned(np.radians(2.0))
    off[:2, 3] = 0.006, -0.005
    found = refined_motion(view, view, off)
    assert found is not None
    # The surface is its own target: nothing but the end of the descent is left of the error.
    np.testing.assert_allclose(found, np.eye(4), atol=2e-4)


def test_surfaces_far_from_each_other_have_no_motion(blocks_seen) -> None:
    view = blocks_seen()
    away = np.eye(4)
    away[2, 3] = 0.5
    assert refined_motion(view, view, away) is None
