"""A small library's worth of performance, as the baselines read it."""

import numpy as np
import pytest

from lifelore.interaction.library.policy_library import PolicyLibrary

MEAN = np.array([[1.0, 0.2, 0.4, 0.0], [0.0, 0.8, 0.6, 0.1]])
DEVIATION = np.full((2, 4), 0.1)


@pytest.fixture
def library():
    """Two types of four policies; the first type is three times as common."""
    return PolicyLibrary.from_means(MEAN, DEVIATION, prior=[0.75, 0.25])
