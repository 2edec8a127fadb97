"""Agreement of views of blocks, counted by hand."""

import numpy as np
import pytest

from lifelore.perception.registration.agreement import AGAINST, Agreement, agreement

ONE = ((0.0, 0.0, 0.1, 0.1, 0.05),)
TWO = (*ONE, (-0.13, -0.13, 0.1, 0.1, 0.08))


def test_a_view_agrees_with_itself(blocks_seen) -> None:
    view = blocks_seen()
    found = agreement(view, view, np.eye(4))
    assert (found.contradicting, found.share) == (0, 1.0)
    assert found.evidence > 0.9


def test_a_block_on_the_other_views_bare_table_contradicts(blocks_seen) -> None:
    one, two = blocks_seen(blocks=ONE), blocks_seen(blocks=TWO)
    # Each frame has the middle of its own objects at x = y = 0.
    motion = np.eye(4)
    motion[:3, 3] = (one.from_view @ np.linalg.inv(two.from_view))[:3, 3]
    found = agreement(one, two, motion)
    # The second block covers a hundred cells of a square centimetre and those that its rims touch.
    assert 100 <= found.contradicting <= 144
    assert 200 <= found.agreeing <= 2 * 144
    assert found.share == pytest.approx(found.agreeing / (found.agreeing + found.contradicting))


def test_evidence_is_a_share_of_all_cells() -> None:
    assert Agreement(60, 10, 100).evidence == pytest.approx((60 - AGAINST * 10) / 100)
    assert Agreement(0, 0, 0).evidence == Agreement(0, 0, 0).share == 0.0
