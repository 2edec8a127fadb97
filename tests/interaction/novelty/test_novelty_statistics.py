import numpy as np
import pytest
from scipy.stats import norm

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.novelty.novelty_statistics import (
    LARGEST_TERM,
    SURPRISE_WEIGHT,
    NoveltyStatistics,
    log_mixture,
)
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.reuse.explanation import MAX_SURPRISE
from lifelore.interaction.signals.category_signal import CategorySignal

LIBRARY = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0)


def _add(statistics, sums, belief, policy, signal):
    return statistics.add(sums, np.array([belief]), np.array([policy]), np.array([signal]))[0]


def test_a_certain_belief_by_hand():
    statistics = NoveltyStatistics(LIBRARY)
    sums = statistics.sums()
    surprise = _add(statistics, sums, [1.0, 0.0], 0, 7.0)
    assert surprise == pytest.approx(-norm.logpdf(7, 10, 2))
    # z² / 2 has mean 1/2 and variance 1/2; the outcome is 1.5 deviations below its mean.
    assert sums.surprise[0] == pytest.approx((1.5**2 / 2 - 0.5) / 0.5**0.5, abs=0.05)
    assert sums.shortfall[0] == pytest.approx(1.5)
    assert statistics.statistic(sums)[0] == pytest.approx(1.5 + SURPRISE_WEIGHT * sums.surprise[0])
    _add(statistics, sums, [1.0, 0.0], 0, 10.0)
    assert (sums.n_signals[0], sums.shortfall[0]) == (2.0, pytest.approx(1.5))
    joined = sums.shortfall[0] + SURPRISE_WEIGHT * sums.surprise[0]
    assert statistics.statistic(sums)[0] == pytest.approx(joined / 2**0.5)


def test_terms_of_known_tasks_have_mean_0_and_variance_1():
    # Under any belief, a signal of a type drawn from that belief: here an uneven belief over two types.
    statistics, n = NoveltyStatistics(LIBRARY), 50_000
    random = np.random.default_rng(0)
    belief = np.tile([0.7, 0.3], (n, 1))
    types = (random.random(n) < 0.3).astype(int)
    policies = random.integers(0, 2, n)
    signals = LIBRARY.performance.mean[types, policies] + 2 * random.standard_normal(n)
    sums = statistics.sums(n)
    statistics.add(sums, belief, policies, signals)
    for terms in (sums.surprise, sums.shortfall):
        assert terms.mean() == pytest.approx(0, abs=5 / n**0.5 + 0.01)
        assert terms.var() == pytest.approx(1, rel=0.05)


def test_log_odds_are_bayes_factors_of_the_broad_law():
    statistics = NoveltyStatistics(LIBRARY)
    sums = statistics.sums()
    fresh = statistics.broad.log_density(np.zeros((1, 3)), np.array([1]), np.array([5.0]))[0]
    surprise = _add(statistics, sums, [0.5, 0.5], 1, 5.0)
    assert sums.log_odds[0] == pytest.approx(fresh + surprise)
    assert sums.shown[0, 1].tolist() == [1.0, 5.0, 0.0]
    assert not sums.shown[0, 0].any()


def test_rows_are_judged_as_single_tasks():
    statistics, random = NoveltyStatistics(LIBRARY), np.random.default_rng(0)
    many, rows = statistics.sums(30), [statistics.sums() for _ in range(30)]
    for _ in range(3):
        belief = random.dirichlet([1, 1], 30)
        policies, signals = random.integers(0, 2, 30), random.normal(5, 6, 30)
        statistics.add(many, belief, policies, signals)
        for i, row in enumerate(rows):
            statistics.add(row, belief[[i]], policies[[i]], signals[[i]])
    for name in ("n_signals", "surprise", "shortfall", "log_odds", "shown"):
        single = np.concatenate([getattr(row, name) for row in rows])
        np.testing.assert_allclose(single, getattr(many, name), rtol=1e-9, atol=1e-12)


def test_impossible_signals_leave_finite_sums():
    library = PolicyLibrary(CategoricalOutcomes([0.0, 1.0], [[[1.0, 0.0]], [[1.0, 0.0]]]))
    statistics = NoveltyStatistics(library)
    sums = statistics.sums()
    assert _add(statistics, sums, [0.5, 0.5], 0, 1.0) == MAX_SURPRISE
    assert sums.surprise[0] == LARGEST_TERM
    assert sums.shortfall[0] == -LARGEST_TERM
    assert np.isfinite(sums.log_odds[0])
    assert sums.log_odds[0] > 100


def test_categories_have_no_shortfall():
    signal = CategorySignal([[[0.5, 0.5]], [[0.9, 0.1]]])
    statistics = NoveltyStatistics(PolicyLibrary.from_means([[1.0], [2.0]], 1.0, signal=signal))
    sums = statistics.sums()
    _add(statistics, sums, [0.5, 0.5], 0, 1.0)
    assert sums.shortfall[0] == 0
    assert statistics.statistic(sums)[0] == sums.surprise[0] > 0


def test_the_log_of_a_mixture():
    belief = np.array([[0.5, 0.5], [0.0, 1.0], [1.0, 0.0], [0.0, 1.0]])
    log_likelihood = np.array([[0.0, -2.0], [0.0, -2000.0], [-np.inf, 0.0], [-np.inf, -np.inf]])
    found = log_mixture(belief, log_likelihood)
    assert found[0] == pytest.approx(np.log(0.5 + 0.5 * np.exp(-2)))
    assert found[1:].tolist() == [-2000.0, -np.inf, -np.inf]
