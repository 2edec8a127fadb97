"""Arrays of probabilities and counts, by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.log_probability import normalised
from lifelore.interaction.signals.category_signal import CategorySignal


def test_log_weights_far_from_0_are_normalised():
    far = np.array([0.0, -2000.0, 900.0])
    shares, total = normalised(np.log([1.0, 3.0]) + far[:, None])
    assert shares == pytest.approx(np.full((3, 2), [0.25, 0.75]))
    assert total == pytest.approx(np.log(4) + far)
    certain, of_one = normalised(np.array([[-np.inf, 5.0]]))
    assert (certain.tolist(), of_one.tolist()) == ([[0.0, 1.0]], [5.0])


@pytest.mark.parametrize("bad", [-1.0, np.inf, np.nan, "best"])
def test_a_pseudo_count_is_a_number_of_at_least_0(bad):
    with pytest.raises(InputError, match="pseudo_count must be at least 0 and finite"):
        CategorySignal.from_samples([[[0, 1]]], pseudo_count=bad)
