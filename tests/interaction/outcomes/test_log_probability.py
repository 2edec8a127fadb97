"""Arrays of probabilities and counts, by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.log_probability import log_of, with_pseudo_counts


def test_log_of_zero_is_minus_infinity_without_a_warning():
    assert log_of(np.array([1.0, 0.0])).tolist() == [0.0, -np.inf]


def test_counts_become_probabilities():
    np.testing.assert_allclose(with_pseudo_counts([[3, 1], [0, 0]], 0.5), [[0.7, 0.3], [0.5, 0.5]])
    np.testing.assert_allclose(with_pseudo_counts([[3, 1], [0, 0]], 0.0), [[0.75, 0.25], [0.5, 0.5]])
    with pytest.raises(InputError, match="counts must be"):
        with_pseudo_counts([[np.inf]], 0.5)
