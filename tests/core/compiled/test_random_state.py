"""The kernels' random numbers: an independent twin, published numbers, and the shape of the law."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from lifelore.core.compiled.jit import kernel
from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.streams import stream

words = st.integers(0, 2**64 - 1)


@kernel
def draw(state, n):
    out = np.empty(n)
    for i in range(n):
        out[i] = next_uniform(state)
    return out


def test_published_outputs_from_state_1_2(big_random):
    # Test vector of the reference implementation, as other libraries carry it.
    published = [
        3,
        412333834243,
        2360170716294286339,
        9295852285959843169,
        2797080929874688578,
        6019711933173041966,
        3076529664176959358,
        3521761819100106140,
        7493067640054542992,
        920801338098114767,
    ]
    twin = big_random((1, 2))
    assert [twin.bits() for _ in published] == published
    drawn = draw(np.array([1, 2], np.uint64), len(published))
    assert drawn.tolist() == [(word >> 11) / 2**53 for word in published]


@given(words, words)
def test_same_as_whole_number_arithmetic(big_random, s0, s1):
    state, twin = np.array([s0, s1], np.uint64), big_random((s0, s1))
    from_kernel = draw(state, 20)
    assert from_kernel.tolist() == [twin.uniform() for _ in range(20)]
    assert state.tolist() == twin.state
    assert ((from_kernel >= 0) & (from_kernel < 1)).all()


def test_largest_draw_stays_below_one():
    # s0 + s1 = 2^64 - 1, all bits set: (2^53 - 1) / 2^53.
    assert draw(np.array([2**64 - 1, 0], np.uint64), 1)[0] == 1 - 2.0**-53


def test_a_state_is_never_all_zero_and_follows_its_generator():
    states = [random_state(stream(seed, "x")) for seed in range(50)]
    assert all(state.dtype == np.uint64 and state[0] & np.uint64(1) for state in states)
    assert len({tuple(state.tolist()) for state in states}) == 50
    assert np.array_equal(random_state(stream(3, "x")), states[3])
