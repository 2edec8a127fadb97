import numpy as np
import pytest
from scipy.stats import t

from lifelore.interaction import CategorySignal, PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.reuse.novelty.broad_library import (
    FREEDOM,
    UNIFORM,
    WEIGHTS,
    broad_counts,
    broad_library,
)
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm

MEAN, DEVIATION = np.array([[10.0, 3.0], [0.0, 3.0]]), np.array([[2.0, 1.0], [2.0, 1.0]])
PRIOR = np.array([0.5, 0.5])


def test_the_first_outcome_is_a_t_as_wide_as_types_and_noise():
    library = PolicyLibrary.from_means(MEAN, DEVIATION)
    # First policy: types at 10 and 0, so a spread of 25 beside a variance of 4. The types agree on the second
    # policy, which gets the mean spread of both policies, 12.5, beside a variance of 1.
    for policy, centre, variance in ((0, 5.0, 4 + 25), (1, 3.0, 1 + 12.5)):
        for value in (-20.0, 5.0, 9.0):
            found = ReuseAlgorithm(broad_library(library)).observe(0, policy, value).log_evidence
            assert found == pytest.approx(t.logpdf(value, FREEDOM, centre, variance**0.5), abs=1e-12)


def test_categories_by_hand():
    # The types have nothing in common: the pooled probabilities (1/2, 1/2, 0) count as the least weight.
    probs = np.array([[[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]])
    counts = broad_counts(probs, PRIOR)[0, 0]
    pooled = (1 - UNIFORM) * np.array([0.5, 0.5, 0.0]) + UNIFORM / 3
    assert counts == pytest.approx(WEIGHTS[0] * pooled)
    library = broad_library(PolicyLibrary.from_means([[1.0], [2.0]], 1.0, signal=CategorySignal(probs)))
    row = ReuseAlgorithm(library)
    assert np.exp(row.observe(0, 0, 2).log_evidence) == pytest.approx(UNIFORM / 3)
    assert np.exp(row.observe(0, 0, 2).log_evidence) == pytest.approx((0.5 * UNIFORM / 3 + 1) / 1.5)


def test_every_kind_of_outcome_has_a_broad_library():
    random = np.random.default_rng(0)
    library = PolicyLibrary(HistogramOutcomes.from_samples(random.normal(0, 1, (2, 2, 80)), 10))
    assert ReuseAlgorithm(broad_library(library)).observe(0, 1, 1e3).log_evidence > -np.inf
    library = PolicyLibrary(CategoricalOutcomes([0.0, 1.0], [[[1.0, 0.0]], [[0.9, 0.1]]]))
    broad = broad_library(library)
    assert broad.n_types == 1
    assert broad.performance.mean[0, 0] == pytest.approx((1 - UNIFORM) * 0.05 + UNIFORM / 2)
