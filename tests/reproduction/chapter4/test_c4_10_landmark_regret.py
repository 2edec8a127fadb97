"""What landmarks cost, by hand and on smooth tables."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lifelore.interaction.library.task_types import epsilon_types
from reproduction.chapter4.c4_10_landmark_regret.run import EXAMPLE, measure, member_regret, parted

TABLES = st.tuples(st.integers(1, 12), st.integers(1, 5)).flatmap(
    lambda shape: arrays(np.float64, shape, elements=st.integers(-20, 20).map(lambda k: k / 4))
)
"""Multiples of a quarter: sums and differences are exact."""


def test_the_example_reaches_two_epsilon():
    # The range is 2: half of it is ε = 1. The second task's best policy costs the first nothing.
    found = parted(np.array(EXAMPLE), 0.5)
    assert (found["shared"], found["largest"], found["past"]) == (2, 2.0, 1)


def test_measures_by_hand():
    def found(past, largest):
        return {"shared": 4, "past": past, "largest": largest}

    results = [{"family": "smooth", "parted": [found(k, 1.2), found(0, 0.5)]} for k in range(3)]
    results.append({"family": "surveillance", "parted": [found(4, 0.9)]})
    measured = measure({}, results)
    # Past ε: 0, 1 and 2 of 8 tasks; the example costs 2 ε.
    assert measured["within"].value == pytest.approx(1 - 3 / 24)
    assert measured["largest_regret"].value == 2.0


@pytest.mark.slow
@settings(deadline=None, max_examples=100)
@given(TABLES, st.integers(0, 40).map(lambda k: k / 8))
def test_the_worst_landmark_by_loops_costs_no_more_than_two_epsilon(utilities, epsilon):
    types = epsilon_types(utilities, epsilon)
    worst = np.zeros(len(utilities))
    for i, j in np.ndindex(len(utilities), len(utilities)):
        if types.labels[i] == types.labels[j]:
            best = [policy for policy, value in enumerate(utilities[i]) if value == max(utilities[i])]
            worst[j] = max([worst[j], *(max(utilities[j]) - utilities[j][policy] for policy in best)])
    np.testing.assert_array_equal(member_regret(utilities, types), worst)
    assert (worst <= 2 * epsilon).all()
