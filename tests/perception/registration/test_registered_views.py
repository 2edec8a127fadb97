"""Several views are placed one by one, and one that fits nowhere is named."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.registration.registered_views import registered_views
from lifelore.perception.registration.start_search import turned

SQUARE = ((0.0, 0.0, 0.1, 0.1, 0.05),)


def test_three_views_stand_in_the_frame_of_the_first(blocks_seen) -> None:
    turns = [0.0, 0.5, -1.2]
    placed = registered_views([blocks_seen(turned(turn)) for turn in turns], ["a", "b", "c"])
    assert placed[0].to is None
    assert placed[0].agreement is None
    for place, turn in zip(placed[1:], turns[1:], strict=True):
        np.testing.assert_allclose(place.pose @ turned(turn), np.eye(4), atol=3e-3)
        assert place.agreement is not None
        assert place.agreement > 0.96


def test_a_view_that_fits_in_many_ways_is_refused_by_name(blocks_seen) -> None:
    with pytest.raises(InputError, match=r"views a\.pcd and b\.pcd cannot be registered surely: .*--poses FILE"):
        registered_views([blocks_seen(blocks=SQUARE), blocks_seen(turned(1.0), SQUARE)], ["a.pcd", "b.pcd"])
