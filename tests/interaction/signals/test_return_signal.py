"""The return as signal is the performance model."""

import numpy as np
import pytest

from lifelore.core import InputError, NotFoundError, SignalModel
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.signals.return_signal import ReturnSignal


def test_likelihood_is_the_outcomes_density_even_after_learning():
    outcomes = GaussianOutcomes([[0.0, 1.0], [2.0, 3.0]], 1.0, count=4)
    signal = ReturnSignal(outcomes)
    assert isinstance(signal, SignalModel)
    np.testing.assert_array_equal(signal.log_likelihood(1, 0.5), outcomes.log_density(1, 0.5))
    outcomes.observe(0, 1, 9.0)
    np.testing.assert_array_equal(signal.log_likelihood(1, 0.5), outcomes.log_density(1, 0.5))
    assert signal.table(4).n_signals == 4
    assert (signal.n_types, signal.n_policies) == (2, 2)


def test_bad_signals():
    signal = ReturnSignal(GaussianOutcomes([[0.0]], 1.0))
    with pytest.raises(InputError, match="value must be a finite number"):
        signal.log_likelihood(0, float("nan"))
    with pytest.raises(NotFoundError, match="unknown policy 1"):
        signal.log_likelihood(1, 0.0)
