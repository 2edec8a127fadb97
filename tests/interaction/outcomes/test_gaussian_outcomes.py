"""Gaussian outcomes by hand and against SciPy."""

import numpy as np
import pytest
from scipy import stats

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes


def test_against_scipy():
    model = GaussianOutcomes([[1.0, -2.0], [4.0, 0.0]], [[1.0, 3.0], [0.5, 2.0]])
    truth = stats.norm(model.mean, model.deviation)
    np.testing.assert_allclose(model.density(0.7), truth.pdf(0.7), rtol=1e-12)
    np.testing.assert_allclose(model.exceedance(0.7), truth.sf(0.7), rtol=1e-12)
    np.testing.assert_allclose(model.log_density(1, 0.7), truth.logpdf(0.7)[:, 1], rtol=1e-12)
    np.testing.assert_allclose(model.cumulative(0, np.array([0.7]))[:, 0], truth.cdf(0.7)[:, 0], rtol=1e-12)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([[np.nan]], 1.0), "mean must be finite"),
        (([[1e101]], 1.0), "mean must be finite"),
        (([1.0], 1.0), "mean must be"),
        (([[1.0]], 0.0), "deviation must be positive"),
        (([[1.0]], np.inf), "deviation must be positive"),
        (([[1.0]], [1.0, 2.0]), "deviation must be one number or of shape"),
        (([[1.0]], 1.0, 0.0), "count must be positive"),
        (([[1.0]], 1.0, np.nan), "count must be positive"),
    ],
)
def test_what_is_no_model_is_refused(arguments, message):
    with pytest.raises(InputError, match=message):
        GaussianOutcomes(*arguments)


def test_without_shrinkage_each_pair_has_its_own_variance():
    samples = np.random.default_rng(1).normal(size=(2, 3, 6))
    model = GaussianOutcomes.from_samples(samples, shrinkage=0)
    assert model.deviation == pytest.approx(samples.std(axis=2, ddof=1))
    samples[0, 1] = 4.0
    with pytest.raises(InputError, match="shrinkage must be positive where a pair's own samples do not differ"):
        GaussianOutcomes.from_samples(samples, shrinkage=0)
