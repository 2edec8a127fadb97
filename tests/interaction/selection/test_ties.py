"""Shares of tied policies in NumPy have the bits of their kernel, and are those of the choice."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lifelore.interaction.selection.choice import choose, tied_shares
from lifelore.interaction.selection.tie_kernels import choose_row, tied_rows
from lifelore.interaction.selection.ties import shares_of_tied

logs = st.one_of(st.floats(-800, 300), st.just(-np.inf), st.sampled_from([0.0, -0.0, -1e308, 1e308]))


def same_bits(one, other) -> bool:
    return np.asarray(one, np.float64).tobytes() == np.asarray(other, np.float64).tobytes()


@pytest.mark.slow
@settings(deadline=None, max_examples=200)
@given(arrays(float, st.integers(1, 9), elements=st.one_of(logs, st.just(np.inf), st.floats(0.999, 1.0))))
def test_shares_go_to_the_policies_that_the_kernel_may_choose(scores):
    uniforms = (np.arange(2520) + 0.5) / 2520  # A multiple of every number of tied policies.
    counts = np.bincount([choose_row(scores, u, 1e-9) for u in uniforms], minlength=len(scores))
    assert tied_shares(scores) == pytest.approx(counts / 2520)


@pytest.mark.slow
@settings(deadline=None, max_examples=300)
@given(
    arrays(
        float,
        st.tuples(st.integers(1, 4), st.integers(1, 9)),
        elements=st.one_of(logs, st.sampled_from([np.inf, np.nan]), st.floats(1 - 3e-9, 1.0)),
    )
)
def test_shares_of_tied(scores):
    shares = np.empty_like(scores)
    tied_rows(scores, 1e-9, shares)
    plain = shares_of_tied(scores, 1e-9)
    assert np.array_equal(np.isnan(plain), np.isnan(shares))
    assert same_bits(np.nan_to_num(plain), np.nan_to_num(shares))


def test_near_ties_share_and_choose_alike():
    scores = np.array([1.0, 1.0 - 5e-10, 1.0 - 2e-9, -np.inf])
    assert tied_shares(scores).tolist() == [0.5, 0.5, 0.0, 0.0]
    assert {choose(scores, np.random.default_rng(seed)) for seed in range(20)} == {0, 1}
