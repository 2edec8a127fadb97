import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import t

from lifelore.interaction.library.broad_law import FREEDOM, BroadCategories, BroadNormals

MEAN, DEVIATION = np.array([[10.0, 0.0], [0.0, 0.0]]), np.array([[2.0, 1.0], [2.0, 1.0]])
PRIOR = np.array([0.5, 0.5])


def _density(law, shown, policy, value):
    return float(np.exp(law.log_density(shown, np.array([policy]), np.array([value])))[0])


def test_the_first_outcome_is_a_t_as_wide_as_types_and_noise():
    law = BroadNormals(MEAN, DEVIATION, PRIOR)
    # Types at 10 and 0: spread 5. Noise 2. So scale² = 4 + 25.
    for value in (-20.0, 5.0, 9.0):
        expected = t.pdf(value, FREEDOM, loc=5.0, scale=29**0.5)
        assert _density(law, np.zeros((1, 3)), 0, value) == pytest.approx(expected)


def test_many_outcomes_leave_their_own_mean_and_deviation():
    law, shown = BroadNormals(MEAN, DEVIATION, PRIOR), np.zeros((1, 3))
    values = np.random.default_rng(0).normal(40.0, 3.0, 5000)
    for value in values:
        law.learn(shown, np.array([value]))
    assert shown[0].tolist() == pytest.approx([5000, values.mean(), 5000 * values.var()])
    assert _density(law, shown, 0, 41.0) == pytest.approx(
        t.pdf(41.0, 5005, loc=values.mean(), scale=values.std()), rel=0.01
    )


def test_densities_integrate_to_one():
    law, shown = BroadNormals(MEAN, DEVIATION, PRIOR), np.array([[3.0, 8.0, 20.0]])
    for policy in (0, 1):
        total = quad(lambda value, policy=policy: _density(law, shown, policy, value), -2000, 2000, points=[0, 8])[
            0
        ]
        assert total == pytest.approx(1, abs=1e-4)


def test_a_single_outcome_has_the_number_of_a_batch():
    law, random = BroadNormals(MEAN, DEVIATION, PRIOR), np.random.default_rng(0)
    shown = np.abs(random.normal(0, 9, (20, 3)))
    policies, values = random.integers(0, 2, 20), random.normal(0, 9, 20)
    many = law.log_density(shown, policies, values)
    single = [law.log_density(shown[[i]], policies[[i]], values[[i]])[0] for i in range(20)]
    np.testing.assert_allclose(single, many, rtol=1e-12)


def test_the_order_of_outcomes_does_not_matter():
    law, values = BroadNormals(MEAN, DEVIATION, PRIOR), np.random.default_rng(1).normal(3, 4, 6)
    totals = []
    for order in (values, values[::-1]):
        shown, total = np.zeros((1, 3)), 0.0
        for value in order:
            total += law.log_density(shown, np.array([0]), np.array([value]))[0]
            law.learn(shown, np.array([value]))
        totals.append(total)
    assert totals[0] == pytest.approx(totals[1], rel=1e-10)


def test_categories_sum_to_one_and_learn_by_hand():
    probs = np.array([[[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]])
    law = BroadCategories(probs, PRIOR)
    # Types have nothing in common: the pooled probabilities (a half, a half, 0) count as the least weight, a half.
    assert law.counts.sum() == pytest.approx(0.5)
    shown, every = np.zeros((3, 3)), np.arange(3.0)
    fresh = np.exp(law.log_density(shown, np.zeros(3, np.int64), every))
    assert fresh.sum() == pytest.approx(1)
    assert fresh[2] == pytest.approx(0.01 / 3)
    law.learn(shown, np.full(3, 2.0))
    after = np.exp(law.log_density(shown, np.zeros(3, np.int64), every))
    assert after[2] == pytest.approx((0.5 * 0.01 / 3 + 1) / 1.5)


def test_types_that_agree_make_heavy_probabilities():
    probs = np.tile([[[0.3, 0.7]]], (2, 1, 1))
    assert BroadCategories(probs, PRIOR).counts.sum() == pytest.approx(1000)
