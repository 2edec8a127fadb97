"""Average precision by hand, against scikit-learn, and its expectation over ties against all orders."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.metrics import average_precision_score

from reproduction.chapter5.c5_02_functional_roles.run import average_precision


def test_by_hand():
    # Relevant at places 1 and 3: (1/1 + 2/3) / 2.
    assert average_precision([0.9, 0.8, 0.7, 0.1], [True, False, True, False]) == pytest.approx(5 / 6)


@given(st.lists(st.booleans(), min_size=1, max_size=30).filter(any), st.randoms())
@settings(max_examples=50, deadline=None)
def test_without_ties_it_is_scikit_learns(relevant, random):
    scores = random.sample(range(1000), len(relevant))
    assert average_precision(scores, relevant) == pytest.approx(average_precision_score(relevant, scores))


@given(st.lists(st.tuples(st.integers(0, 2), st.booleans()), min_size=1, max_size=6))
@settings(max_examples=40, deadline=None)
def test_ties_are_the_mean_over_all_orders(things):
    scores, relevant = (np.array(side) for side in zip(*things, strict=True))
    if not relevant.any():
        relevant[0] = True
    orders = [np.array(order) for order in permutations(range(len(scores)))]
    kept = [relevant[o] for o in orders if (np.diff(scores[o]) <= 0).all()]
    naive = np.mean([np.mean([(hit[: k + 1]).mean() for k in np.flatnonzero(hit)]) for hit in kept])
    assert average_precision(scores, relevant) == pytest.approx(naive)
