"""Log likelihoods of moves from counts, by hand."""

import numpy as np
import pytest

from lifelore.interaction.adaptation.move_model import log_shares


def test_log_shares_by_hand():
    counts = np.array([[[1.0], [3.0], [0.0], [0.0]]])
    assert np.exp(log_shares(counts, 2, 0.5)).ravel().tolist() == pytest.approx([0.3, 0.7, 0.5, 0.5])
