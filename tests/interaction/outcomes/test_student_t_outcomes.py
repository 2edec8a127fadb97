"""Student-t outcomes: the predictive against the integral over mean and variance it stands for, and SciPy."""

import numpy as np
import pytest
from scipy import integrate, stats

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.normal_law import FEW, log_t_height
from lifelore.interaction.outcomes.student_t_outcomes import StudentTOutcomes


@pytest.mark.slow
def test_it_is_the_gaussian_with_its_mean_and_variance_integrated_out():
    data = np.array([[[1.0, 3.0, 2.5], [0.0, 4.0, 1.0]]])
    model = StudentTOutcomes.from_samples(data, shrinkage=3.0)
    moments = model.moments
    freedom, variance, count = moments.freedom[0, 0], moments.variance[0, 0], moments.count[0, 0]

    def at_variance(v, value):
        # Variance ~ scaled inverse χ²; mean ~ Normal(sample mean, v / n), so the outcome has v (1 + 1 / n).
        weight = stats.invgamma(freedom / 2, scale=freedom * variance / 2).pdf(v)
        return weight * stats.norm(data[0, 0].mean(), np.sqrt(v * (1 + 1 / count))).pdf(value)

    for value in (-3.0, 1.0, 2.5, 9.0):
        expected = integrate.quad(at_variance, 0, np.inf, args=(value,), limit=200)[0]
        assert model.density(value)[0, 0] == pytest.approx(expected, rel=1e-6)


def test_too_little_known_for_a_deviation_is_refused():
    with pytest.raises(InputError, match="more than 2 and finitely many degrees of freedom"):
        StudentTOutcomes([[1.0]], 1.0, 2)
    with pytest.raises(InputError, match="degrees of freedom"):
        StudentTOutcomes.from_samples([[[1.0]]], shrinkage=1.0)


def test_the_height_of_the_density_is_that_of_scipy():
    """SciPy's log Γ loses digits at large degrees of freedom: the bound is 1e-15 times the logarithm there."""
    few = np.concatenate([np.geomspace(1e-3, 1e4, 57), np.arange(1, 30)])
    many = np.tile(few, 5)
    expected = stats.t(few).logpdf(0)
    assert log_t_height(few) == pytest.approx(expected, rel=2e-11)
    assert log_t_height(few[:40]) == pytest.approx(expected[:40], rel=1e-13)
    assert len(many) > FEW
    assert log_t_height(many) == pytest.approx(np.tile(log_t_height(few), 5), rel=1e-15)
    exact = np.full((3, 1), 1e30)
    assert log_t_height(exact) == pytest.approx(stats.norm.logpdf(0), rel=1e-15)
