"""The plain twin of uncertain models, beside numbers by hand, Student's t and known special cases."""

from math import exp, inf, log, sqrt

import pytest
from scipy import stats

from . import naive_models as naive
from .naive_reuse import normal_log_density

PRECISE = 1e-9
PAIR = naive.NormalPair(mean=3.0, variance=4.0, runs=10.0, freedom=14.0)
PAIRS = [
    PAIR,
    naive.NormalPair(0.0, 1.0, 2.0, 2.0),
    naive.NormalPair(-20.0, 1e-2, 3.0, 2.5),
    naive.NormalPair(0.0, 1.0, 2.0, 300.0),
]


def shown(*values: float) -> list[tuple[float, float]]:
    return [(value, 1.0) for value in values]


# ---- normal outcomes --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("pair", PAIRS)
@pytest.mark.parametrize("spread", [0.0, 0.3, 50.0])
def test_the_first_outcome_has_a_t_distribution(pair, spread):
    """Location m₀, ν degrees of freedom, scale² = v₀ (1 + 1/n + ρ)."""
    scale = sqrt(pair.variance * (1 + 1 / pair.runs + spread))
    for z in (0.0, -7.0, 40.0):
        value = pair.mean + z * scale
        found = naive.normal_predictive(pair, spread, [], value)
        assert found == pytest.approx(stats.t.logpdf(value, pair.freedom, pair.mean, scale), abs=PRECISE)


def test_a_second_outcome_by_hand():
    """n = 1, ν = 2, m₀ = 0, v₀ = 1 and a first outcome 2: κ = 2, m = 1, ν = 3, ν v = 2 + ½ · 4 = 4."""
    pair = naive.NormalPair(0.0, 1.0, 1.0, 2.0)
    scale = sqrt(4 / 3 * 1.5)
    for value in (1.0, -2.5, 9.0):
        expected = stats.t.logpdf(value, 3, 1.0, scale)
        assert naive.normal_predictive(pair, 0.0, shown(2.0), value) == pytest.approx(expected, abs=PRECISE)


def test_exact_pairs_are_normal_and_a_known_variance_leaves_the_mean_in_doubt():
    exact = naive.NormalPair(3.0, 4.0, inf, inf)
    assert naive.normal_predictive(exact, 0.0, shown(7.0, 8.0), 5.0) == pytest.approx(
        normal_log_density(5.0, 3.0, 2.0), abs=PRECISE
    )
    # With ρ = 1 the mean has the variance 4; after 7 its law is N(5, 2) and the next outcome N(5, 6).
    assert naive.normal_predictive(exact, 1.0, shown(7.0), 6.0) == pytest.approx(
        normal_log_density(6.0, 5.0, sqrt(6.0)), abs=PRECISE
    )


def test_moments_by_hand():
    """Before: E[m] = 3, E[v] = 4 · 14/12. After 7: κ = 11, m = 37/11, ν = 15, ν v = 56 + 10/11 · 16."""
    before = naive.normal_moments(PAIR, 0.0, [])
    noise = 4 * 14 / 12
    assert before == pytest.approx((3.0, noise / 10, noise), rel=PRECISE)
    after = naive.normal_moments(PAIR, 0.0, shown(7.0))
    noise = (56 + 160 / 11) / 13
    assert after == pytest.approx((37 / 11, noise / 11, noise), rel=PRECISE)


def test_moments_over_spreads_by_hand():
    two = [naive.Moments(1.0, 2.0, 5.0), naive.Moments(3.0, 4.0, 7.0)]
    # Mean 1.5; ¾ (2 + ¼) + ¼ (4 + 2¼) = 3.25.
    assert naive.over_spreads(two, [0.75, 0.25]) == pytest.approx((1.5, 3.25, 5.5))


def test_an_outcome_of_half_the_weight_counts_as_half_an_outcome():
    """Two halves of the same outcome are one outcome."""
    halves = [(7.0, 0.5), (7.0, 0.5)]
    found = naive.normal_predictive(PAIR, 0.3, halves, 2.0)
    assert found == pytest.approx(naive.normal_predictive(PAIR, 0.3, shown(7.0), 2.0), abs=PRECISE)
    nothing = naive.normal_predictive(PAIR, 0.3, [(7.0, 0.0)], 2.0)
    assert nothing == pytest.approx(naive.normal_predictive(PAIR, 0.3, [], 2.0), abs=PRECISE)


# ---- categories -------------------------------------------------------------------------------------------------


def test_categories_by_hand():
    """Counts 1, 3: ¾ for the second; after it 4/5, and after the first too 4/6."""
    counts = [1.0, 3.0]
    assert exp(naive.category_predictive(counts, 0.0, [], 1)) == pytest.approx(3 / 4)
    assert exp(naive.category_predictive(counts, 0.0, shown(1), 1)) == pytest.approx(4 / 5)
    assert exp(naive.category_predictive(counts, 0.0, shown(1, 0), 1)) == pytest.approx(4 / 6)
    # ρ = ¼ halves the weight of four counts: ½, 1½ balls.
    assert exp(naive.category_predictive(counts, 0.25, shown(0), 0)) == pytest.approx(1.5 / 3)
    assert naive.category_predictive([0.0, 3.0], 0.5, [], 0) == -inf


# ---- the belief -------------------------------------------------------------------------------------------------

COUNTS = [[[1.0, 3.0]], [[2.0, 2.0]]]


def test_a_belief_by_hand():
    """Prior ½, ½; categories 1, 1: ¾ · 4/5 = 0.6 against ½ · 3/5 = 0.3."""
    agent = naive.NaiveUncertainReuse([0.5, 0.5], [0.0], [1.0], naive.category_law(COUNTS))
    assert agent.update(0, 1) == pytest.approx(log(0.625))
    agent.update(0, 1)
    assert agent.belief == pytest.approx([2 / 3, 1 / 3])


def test_spreads_by_hand():
    """Spreads 0 and ¾: weights of 4 and 1 count. A first category says nothing of the spread.

    The second has 4/5 and 3/5 under ρ = 0, (¾ + 1) / 2 and (½ + 1) / 2 under ρ = ¾.
    """
    agent = naive.NaiveUncertainReuse([0.5, 0.5], [0.0, 0.75], [0.5, 0.5], naive.category_law(COUNTS))
    agent.update(0, 1)
    assert (agent.belief, agent.weights) == (pytest.approx([0.6, 0.4]), pytest.approx([0.5, 0.5]))
    agent.update(0, 1)
    first, second = (0.8 + 0.875) / 2, (0.6 + 0.75) / 2
    assert agent.belief[0] == pytest.approx(0.6 * first / (0.6 * first + 0.4 * second))
    gains = 0.6 * 0.8 + 0.4 * 0.6, 0.6 * 0.875 + 0.4 * 0.75
    assert agent.weights[0] == pytest.approx(gains[0] / sum(gains))


def test_a_hazard_by_hand():
    """A rate of ½, prior ½, ½: each type has just changed with probability ½ at first, which changes nothing.

    After category 1 the belief is 0.6, 0.4, and 0.55, 0.45 after the hazard. Then the types have just changed with
    probabilities ¼ / 0.55 and ¼ / 0.45.
    """
    agent = naive.NaiveUncertainReuse([0.5, 0.5], [0.0], [1.0], naive.category_law(COUNTS), rate=0.5)
    agent.update(0, 1)
    assert agent.belief == pytest.approx([0.55, 0.45])
    assert agent.shown == {0: [(1, 1.0)]}
    changed = 0.25 / 0.55, 0.25 / 0.45
    likelihood = [(1 - changed[0]) * 0.8 + changed[0] * 0.75, (1 - changed[1]) * 0.6 + changed[1] * 0.5]
    joint = [0.55 * likelihood[0], 0.45 * likelihood[1]]
    agent.update(0, 1)
    after = [j / sum(joint) for j in joint]
    assert agent.belief == pytest.approx([0.5 * a + 0.25 for a in after])
    anew = after[0] * changed[0] * 0.75 / likelihood[0] + after[1] * changed[1] * 0.5 / likelihood[1]
    assert agent.shown[0] == [(1, pytest.approx(1 - anew)), (1, 1.0)]


def test_several_signals_of_an_episode_share_a_single_step_by_hand():
    """Categories 1, 1 with a rate of 0.1: 0.6 against 0.3 within the episode, then 0.9 · 2/3 + 0.05."""
    agent = naive.NaiveUncertainReuse([0.5, 0.5], [0.0], [1.0], naive.category_law(COUNTS), rate=0.1)
    agent.observe(0, 1)
    agent.observe(0, 1)
    assert agent.belief == pytest.approx([2 / 3, 1 / 3])
    agent.end_episode()
    assert agent.belief == pytest.approx([0.65, 0.35])


def test_what_no_type_explains_teaches_nothing():
    counts = [[[0.0, 2.0]], [[0.0, 1.0]]]
    agent = naive.NaiveUncertainReuse([0.5, 0.5], [0.0], [1.0], naive.category_law(counts))
    assert agent.update(0, 0) == -inf
    assert (agent.belief, agent.shown) == (pytest.approx([0.5, 0.5]), {})
