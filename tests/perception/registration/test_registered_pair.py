"""Two views of blocks are registered where their objects fit in one way, and doubted where they fit in several."""

import numpy as np
import pytest

from lifelore.perception.registration.agreement import Agreement
from lifelore.perception.registration.registered_pair import Registration, is_apart, registered_pair
from lifelore.perception.registration.start_search import turned


def tilted_away() -> np.ndarray:
    """A camera's frame: the table turned by 70°, tilted by 30° and 0.9 m away."""
    cosine, sine = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    motion = np.eye(4)
    motion[1, 1:3], motion[2, 1:3], motion[:3, 3] = (cosine, -sine), (sine, cosine), (0.1, -0.2, 0.9)
    return motion @ turned(np.radians(70.0))


def test_the_motion_between_two_cameras_is_found(blocks_seen) -> None:
    away = tilted_away()
    found = registered_pair(blocks_seen(), blocks_seen(away))
    assert found.doubt is None
    np.testing.assert_allclose(found.motion @ away, np.eye(4), atol=3e-3)


@pytest.mark.parametrize(
    "blocks",
    [((0.0, 0.0, 0.1, 0.1, 0.05),), ((0.0, 0.0, 0.1, 0.06, 0.05), (0.2, 0.0, 0.1, 0.06, 0.05))],
    ids=["a square block", "two blocks alike"],
)
def test_objects_that_fit_in_more_than_one_way_are_doubted(blocks_seen, blocks) -> None:
    found = registered_pair(blocks_seen(blocks=blocks), blocks_seen(turned(0.6), blocks))
    assert found.doubt == "their objects fit in more than one way"


def test_an_object_that_moved_between_the_views_is_doubted(blocks_seen) -> None:
    before = ((-0.1, -0.1, 0.12, 0.06, 0.08), (0.1, 0.0, 0.06, 0.06, 0.15))
    after = (before[0], (0.02, 0.12, 0.06, 0.06, 0.15))
    found = registered_pair(blocks_seen(blocks=before), blocks_seen(blocks=after))
    assert found.doubt is not None


def test_the_place_where_a_small_object_moved_is_named(blocks_seen) -> None:
    """Most of the cells agree: only 3 % of them are the small block's, on the table of the other view."""
    large = ((-0.2, -0.15, 0.2, 0.2, 0.08), (0.05, -0.1, 0.14, 0.2, 0.15))
    before, after = ((*large, (0.1, 0.2, 0.03, 0.03, 0.04)), (*large, (0.1, 0.28, 0.03, 0.03, 0.04)))
    away = tilted_away()
    found = registered_pair(blocks_seen(away, before), blocks_seen(blocks=after))
    assert found.agreement.share > 0.96
    assert found.moved is not None
    assert "something moved between them, at " in str(found.doubt)
    place = (found.moved - away[:3, 3]) @ away[:3, :3]
    assert min(np.linalg.norm(place - [0.115, y, 0.02]) for y in (0.215, 0.295)) < 0.015
    still = registered_pair(blocks_seen(away, before), blocks_seen(blocks=before))
    assert (still.moved, still.doubt) == (None, None)


def test_doubts_in_words() -> None:
    assert Registration(np.eye(4), Agreement(90, 1, 100), 0.2).doubt is None
    assert "fit in more than one way" in str(Registration(np.eye(4), Agreement(90, 1, 100), 0.8).doubt)
    assert "too little of the same objects" in str(Registration(np.eye(4), Agreement(30, 0, 100), 0.0).doubt)
    assert "contradict each other" in str(Registration(np.eye(4), Agreement(80, 10, 100), 0.0).doubt)


def test_motions_apart_differ_by_turn_or_shift() -> None:
    moved = np.eye(4)
    moved[0, 3] = 0.03
    assert is_apart(moved, np.eye(4))
    assert is_apart(turned(np.radians(6.0)), np.eye(4))
    assert not is_apart(turned(np.radians(-4.0)), np.eye(4))
