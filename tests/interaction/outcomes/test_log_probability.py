"""Arrays of probabilities and counts, by hand."""

import numpy as np
import pytest

from lifelore.interaction.outcomes.log_probability import normalised


def test_log_weights_far_from_0_are_normalised():
    far = np.array([0.0, -2000.0, 900.0])
    shares, total = normalised(np.log([1.0, 3.0]) + far[:, None])
    assert shares == pytest.approx(np.full((3, 2), [0.25, 0.75]))
    assert total == pytest.approx(np.log(4) + far)
    certain, of_one = normalised(np.array([[-np.inf, 5.0]]))
    assert (certain.tolist(), of_one.tolist()) == ([[0.0, 1.0]], [5.0])
