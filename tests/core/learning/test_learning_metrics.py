"""The five measures of transfer: by hand, and what must hold of any curves."""

import numpy as np
import pytest

from lifelore.core import InputError, learning_gain, mean_estimate
from lifelore.core.learning.learning_metrics import episodes_to_threshold

WITH = [[2.0, 4.0, 8.0, 10.0], [1.0, 9.0, 9.0, 9.0], [3.0, 3.0, 7.0, 7.0]]
WITHOUT = [[0.0, 0.0, 4.0, 8.0], [0.0, 3.0, 6.0, 9.0], [1.0, 1.0, 1.0, 5.0]]


def test_episodes_to_threshold_by_hand():
    returns = np.array([0.0, 4.0, 0.0, 4.0, 8.0])
    assert episodes_to_threshold(returns, 4.0) == 2
    assert episodes_to_threshold(returns, 4.0, window=3) == 5  # means 4/3, 8/3, 4
    assert episodes_to_threshold(returns, 9.0) is None
    assert episodes_to_threshold(np.ones(10), 1.0, window=10) == 10  # a steady 1 has the mean 1


def test_all_measures_by_hand():
    gain = learning_gain(WITH, WITHOUT, threshold=[8.0, 9.0, 6.0], share=0.5)
    assert gain.jumpstart == mean_estimate([2.0, 1.0, 2.0])
    assert gain.asymptote == mean_estimate([3.0, 1.5, 4.0])  # last two of four: 9-6, 9-7.5, 7-3
    assert gain.total_reward == mean_estimate([12.0, 10.0, 12.0])
    assert gain.transfer_ratio.value == pytest.approx(34 / 38)
    # Episodes 3, 2, 3 against 4, 4 and never, which counts as all four.
    assert gain.threshold_ratio.value == pytest.approx(8 / 12)
    assert gain.threshold_saved == mean_estimate([1.0, 2.0, 1.0])
    assert (gain.never, gain.baseline_never) == (0, 1)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"curves": [1.0, 2.0]}, r"curves must be finite and \(n_runs, n_episodes\).*got \(2,\)"),
        ({"baseline": [[np.nan] * 4] * 3}, "baseline must be finite"),
        ({"baseline": WITHOUT[:2]}, r"must agree run by run, got \(3, 4\) and \(2, 4\)"),
        ({"threshold": [1.0, 2.0]}, r"threshold must be one number or one a run \(3\), got \(2,\)"),
        ({"threshold": np.nan}, "threshold and floor must be finite"),
        ({"floor": np.nan}, "threshold and floor must be finite"),
        ({"share": 0.0}, r"share must lie in \(0, 1\], got 0.0"),
    ],
)
def test_arguments_that_break_a_rule(change, words):
    with pytest.raises(InputError, match=words):
        learning_gain(**({"curves": WITH, "baseline": WITHOUT, "threshold": 5.0} | change))
