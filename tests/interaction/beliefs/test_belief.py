"""Beliefs over types: by hand, as the slow twin, and a million hostile updates."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.belief import log_prior, log_sum, update

from ..twins import naive_reuse as naive

INF = math.inf


@pytest.mark.parametrize(("dtype", "close"), [("f8", 1e-12), ("f4", 1e-5)])
@pytest.mark.parametrize("others", [[], [[-900.0, -901.0, -INF]], [[720.0, -3.0, 719.0]], [[-INF, -INF, -INF]]])
def test_sums_of_rows_however_large_or_small(others, dtype, close):
    rows = np.array([[-1.0, -2.0, -INF], [0.5, -40.0, 3.0], *others], dtype)
    assert log_sum(rows) == pytest.approx(np.array([naive.log_sum(row) for row in rows.tolist()]), rel=close)


def test_a_belief_of_zero_stays_zero_and_a_tiny_one_may_rise_again():
    belief = log_prior([0.5, 0.5, 0.0])
    for _ in range(100):
        belief = update(belief, [0.0, -50.0, 0.0]).log_belief
    assert belief[1] == pytest.approx(-5000, rel=1e-3)
    assert np.exp(belief).tolist() == [1.0, 0.0, 0.0]
    for _ in range(101):
        belief = update(belief, [-50.0, 0.0, 0.0]).log_belief
    assert np.exp(belief) == pytest.approx([0.0, 1.0, 0.0])
    assert belief[2] == -INF


def test_many_users_broadcast():
    beliefs = np.log(np.random.default_rng(0).dirichlet(np.ones(4), (3, 5)))
    said = np.random.default_rng(1).normal(size=(5, 4))
    together = update(beliefs, said)
    assert together.log_belief.shape == (3, 5, 4)
    assert together.log_evidence.shape == (3, 5)
    for i in range(3):
        for j in range(5):
            alone = update(beliefs[i, j], said[j])
            assert alone.log_belief == pytest.approx(together.log_belief[i, j], rel=1e-13)
            assert alone.log_evidence == pytest.approx(together.log_evidence[i, j], rel=1e-13)


LOGS = st.one_of(st.floats(-800, 300), st.just(-INF))


@settings(deadline=None, max_examples=30)
@given(st.lists(st.tuples(LOGS, LOGS), min_size=1, max_size=9))
def test_agrees_with_the_slow_twin(pairs):
    weights, said = zip(*pairs, strict=True)
    if max(weights) == -INF:
        weights = (0.0,) * len(weights)
    belief = naive.normalised(weights)
    after, (expected, evidence) = update(belief, said), naive.bayes(belief, said)
    assert after.log_belief == pytest.approx(expected, rel=1e-12, abs=1e-12)
    assert after.log_evidence == pytest.approx(evidence, rel=1e-12, abs=1e-12)
    assert (after.log_belief <= 0).all()


@pytest.mark.parametrize(
    ("prior", "rule"),
    [([0.5, 0.4], "sum to 1, got 0.9"), ([1.5, -0.5], "negative"), ([math.nan, 1.0], "NaN"), ([], "shape")],
)
def test_priors_that_are_none_are_refused(prior, rule):
    with pytest.raises(InputError, match=rule):
        log_prior(prior)
