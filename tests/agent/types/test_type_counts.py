"""The laws of types where they differ, where they agree, and where one has shown nothing."""

import numpy as np
import pytest

from lifelore.agent.types.type_counts import TypeCounts

BROAD, KINDS = np.full((6, 3), 1 / 3), np.zeros(6, np.int64)


def of(*rows):
    """Types with these numbers of two outcomes in all causes, or by cause; none of the rest was shown."""
    counts = np.zeros((len(rows), 6, 3))
    counts[:, :, :2] = [np.broadcast_to(row, (6, 2)) for row in rows]
    return TypeCounts(counts, BROAD, KINDS)


def test_types_that_differ_in_all_causes_are_certain_each():
    known = of((8, 0), (0, 8))
    assert known.apart.min() > 0.95
    assert known.laws[0, :, 0].min() > 0.9
    assert known.laws[1, :, 1].min() > 0.9
    assert len(known.joined()) == 2


def test_types_that_agree_have_one_law_also_where_causes_are_noisy():
    known = of((4, 4), (4, 4))
    assert known.apart.max() < 0.5
    assert known.laws[:, :, :2] == pytest.approx(np.full((2, 6, 2), 0.5), abs=0.1)


def test_a_type_that_has_shown_nothing_is_as_others_where_these_agree():
    rows = np.array([[8, 0]] * 3 + [[0, 8]] * 3)
    laws = of((8, 0), rows, (0, 0)).laws[2]
    assert laws[:3, 0].min() > 0.75 > laws[3:, 0].max()
    assert laws[3:, 0] == pytest.approx(laws[3:, 1], abs=0.1)
