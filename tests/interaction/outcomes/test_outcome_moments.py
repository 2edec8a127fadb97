"""Moments pair by pair, against plain loops."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.outcome_moments import moments
from lifelore.interaction.outcomes.outcome_rows import rows_of_samples


def naive(samples, shrinkage):
    """Mean and shrunk variance of every pair, one at a time."""
    groups = {pair: samples[pair][~np.isnan(samples[pair])] for pair in np.ndindex(samples.shape[:2])}
    squares = {pair: sum((value - values.mean()) ** 2 for value in values) for pair, values in groups.items()}
    freedom = sum(len(values) - 1 for values in groups.values())
    pooled = sum(squares.values()) / freedom
    variance = {
        pair: (shrinkage * pooled + squares[pair]) / (shrinkage + len(values) - 1)
        for pair, values in groups.items()
    }
    return groups, variance, pooled


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000), st.floats(0.5, 20))
def test_against_the_naive_twin(seed, shrinkage):
    generator = np.random.default_rng(seed)
    samples = generator.normal(5, 3, (3, 2, 5))
    samples[generator.random(samples.shape) < 0.3] = np.nan
    samples[..., 0] = np.nan_to_num(samples[..., 0])
    samples[0, 0] = generator.normal(size=5)
    found = moments(rows_of_samples(samples), shrinkage)
    groups, variance, pooled = naive(samples, shrinkage)
    for pair, values in groups.items():
        assert found.mean[pair] == pytest.approx(values.mean())
        assert found.variance[pair] == pytest.approx(variance[pair])
        assert found.count[pair] == len(values)
    assert found.pooled == pytest.approx(pooled)


def test_arrays_that_are_no_moments_are_refused():
    good = moments(rows_of_samples([[[1.0, 2.0]]])).to_arrays()
    restore = type(moments(rows_of_samples([[[1.0, 2.0]]]))).from_arrays
    for name, value in [("mean", [[np.nan]]), ("variance", [[0.0]]), ("count", [[-1.0]]), ("pooled", 0.0)]:
        with pytest.raises(InputError):
            restore(good | {name: np.array(value)})
    with pytest.raises(InputError, match="share one shape"):
        restore(good | {"mean": np.zeros((2, 1))})
