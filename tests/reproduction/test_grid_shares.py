"""Cells of a grid judged by their intervals."""

import pytest

from lifelore.core.metrics import Estimate
from reproduction.engine.estimates import is_above, is_below, share_of


@pytest.mark.parametrize(
    ("interval", "above", "below"),
    [((1.1, 2.0), True, False), ((0.1, 0.9), False, True), ((0.9, 1.1), False, False), (None, False, False)],
)
def test_a_cell_counts_where_its_whole_interval_lies_beyond_the_bound(interval, above, below):
    number = Estimate(1.0, 1.0, interval, 5)
    assert (is_above(number, 1.0), is_below(number, 1.0)) == (above, below)


def test_shares_are_counts_of_all_cells():
    assert share_of([True, False, False, True, True]) == Estimate(0.6, 1.0, None, 5)
