"""Streams by name: they never move between versions, and never meet."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.core.streams import stream

GOLDEN = [[481675837, 459878163, 553981985], [426790894, 407491801, 684286658], [299216088, 476765829, 100931662]]
names = st.lists(st.one_of(st.integers(-(10**9), 10**9), st.text("abc 09", max_size=5)), max_size=3)


def test_golden_numbers():
    # A change here moves every published result: say so in CHANGELOG under *numbers*.
    assert stream(0).integers(0, 10**9, 3).tolist() == GOLDEN[0]
    assert stream(7, "task", 3).integers(0, 10**9, 3).tolist() == GOLDEN[1]
    assert stream(-1, "C3.2", "q-learning", 12).integers(0, 10**9, 3).tolist() == GOLDEN[2]


@pytest.mark.slow
@given(st.integers(-(10**12), 10**12), names, st.integers(-(10**12), 10**12), names)
def test_depends_on_seed_and_names_alone(seed, path, other_seed, other_path):
    same = [(type(n), n) for n in (seed, *path)] == [(type(n), n) for n in (other_seed, *other_path)]
    first, second = stream(seed, *path), stream(other_seed, *other_path)
    assert (first.bit_generator.state == second.bit_generator.state) == same
