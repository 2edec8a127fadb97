"""The plain twin of uncertain models, beside numbers by hand, Student's t and known special cases."""

from math import exp, inf, log, sqrt

import pytest
from scipy import stats

from . import naive_models as naive

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


def test_moments_by_hand():
    """Before: E[m] = 3, E[v] = 4 · 14/12. After 7: κ = 11, m = 37/11, ν = 15, ν v = 56 + 10/11 · 16."""
    before = naive.normal_moments(PAIR, 0.0, [])
    noise = 4 * 14 / 12
    assert before == pytest.approx((3.0, noise / 10, noise), rel=PRECISE)
    after = naive.normal_moments(PAIR, 0.0, shown(7.0))
    noise = (56 + 160 / 11) / 13
    assert after == pytest.approx((37 / 11, noise / 11, noise), rel=PRECISE)


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
