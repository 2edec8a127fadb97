"""Pairs without a sample: guessed by hand, learnt from like others, and no certainty where nothing was seen."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes

NAN = float("nan")
SAMPLES = np.array(
    [
        [[9.0, 11.0], [1.0, -1.0], [4.0, 6.0]],
        [[1.0, -1.0], [9.0, 11.0], [4.0, 6.0]],
        [[5.0, 5.0], [NAN, NAN], [NAN, 2.0]],
    ]
)


def test_a_guess_by_hand():
    moments = GaussianOutcomes.from_samples(SAMPLES, gaps=True).moments
    means = np.array([10, 0, 5, 0, 10, 5, 5, 2])
    assert moments.mean[2, 1] == pytest.approx((0 + 10 + means.mean()) / 3)
    between = np.mean([np.var([10, 0, 5], ddof=1), np.var([0, 10], ddof=1), np.var([5, 5, 2], ddof=1)])
    assert moments.count[2, 1] == pytest.approx(moments.variance[2, 1] / between)
    assert moments.variance[2, 1] == pytest.approx(moments.pooled)
    assert moments.count[2, 2] == 1


def test_a_new_type_or_policy_with_gaps():
    library = PolicyLibrary.from_samples(SAMPLES[:2])
    grown = library.with_type([[5.0, 5.0], [NAN, NAN], [NAN, 2.0]], "new", gaps=True)
    whole = PolicyLibrary.from_samples(SAMPLES, gaps=True)
    assert grown.performance.mean == pytest.approx(whole.performance.mean)
    wider = grown.with_policy([[NAN], [NAN], [20.0]], gaps=True)
    assert wider.performance.mean[2, 3] == 20
    assert wider.performance.mean[0, 3] == pytest.approx(
        (20 + grown.with_policy([[20.0]] * 3).performance.mean.mean()) / 2, abs=3
    )
    with pytest.raises(InputError, match="every pair of type and policy needs a sample"):
        library.with_type([[5.0], [NAN], [2.0]])
    counted = PolicyLibrary.from_samples([[[0.0, 1.0]]], model="categorical")
    with pytest.raises(InputError, match="gaps are guessed by"):
        counted.with_type([[NAN]], gaps=True)
