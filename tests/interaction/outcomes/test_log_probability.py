"""Arrays of probabilities and counts, by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.log_probability import checked_counts, log_of, normalised


def test_log_of_zero_is_minus_infinity_without_a_warning():
    assert log_of(np.array([1.0, 0.0])).tolist() == [0.0, -np.inf]


def test_log_weights_far_from_0_are_normalised():
    far = np.array([0.0, -2000.0, 900.0])
    shares, total = normalised(np.log([1.0, 3.0]) + far[:, None])
    assert shares == pytest.approx(np.full((3, 2), [0.25, 0.75]))
    assert total == pytest.approx(np.log(4) + far)
    certain, of_one = normalised(np.array([[-np.inf, 5.0]]))
    assert (certain.tolist(), of_one.tolist()) == ([[0.0, 1.0]], [5.0])


def test_counts_behind_rows_are_one_number_or_a_number_for_each():
    assert checked_counts(3, (2, 1)).tolist() == [[3.0], [3.0]]
    assert checked_counts([[1], [2]], (2, 1)).tolist() == [[1.0], [2.0]]
    for bad in (0, np.inf, [1.0, 2.0], [[1], [-1]]):
        with pytest.raises(InputError, match="count must be"):
            checked_counts(bad, (2, 1))
