"""Student-t outcomes: the predictive against the integral over mean and variance it stands for, and SciPy."""

import numpy as np
import pytest
from scipy import integrate, stats

from lifelore.core.errors import InputError
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
