"""A small library's worth of performance, as the baselines read it."""

from types import SimpleNamespace

import numpy as np
import pytest

MEAN = np.array([[1.0, 0.2, 0.4, 0.0], [0.0, 0.8, 0.6, 0.1]])
DEVIATION = np.full((2, 4), 0.1)


@pytest.fixture
def library():
    """Two types of four policies; the first type is three times as common."""
    performance = SimpleNamespace(mean=MEAN, deviation=DEVIATION, bounds=lambda: (-0.4, 1.4))
    return SimpleNamespace(n_policies=4, n_types=2, prior=np.array([0.75, 0.25]), performance=performance)
