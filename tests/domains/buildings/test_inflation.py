"""Inflation against a twin that measures every distance."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from lifelore.domains.buildings.inflation import inflate


def inflate_slowly(occupied, radius):
    """The definition, pixel by pixel."""
    obstacles = np.argwhere(occupied)
    blocked = np.zeros_like(occupied)
    for place in np.ndindex(occupied.shape):
        squared = ((obstacles - place) ** 2).sum(axis=1)
        blocked[place] = (squared <= radius**2 * (1 + 1e-8)).any()
    return blocked


@settings(max_examples=80, deadline=None)
@given(
    arrays(
        bool, array_shapes(min_dims=2, max_dims=2, max_side=12), elements=st.sampled_from([True] + [False] * 9)
    ),
    st.floats(0, 20) | st.sampled_from([0.0, 1.0, 2**0.5, 2.0, 5.0, 1e9]),
)
def test_equals_the_twin(occupied, radius):
    assert np.array_equal(inflate(occupied, radius), inflate_slowly(occupied, radius))


@pytest.mark.parametrize("pixels", range(1, 30))
def test_whole_pixels_count_whatever_the_floats_say(pixels):
    # 0.1 * 3 / 0.1 is not 3 in floats, and 0.3 / 0.1 is less.
    occupied = np.zeros((1, 32), bool)
    occupied[0, 0] = True
    assert inflate(occupied, (pixels / 10) / 0.1).sum() == pixels + 1
