"""Folding against a plain dictionary, and its arithmetic at the edge of 64 bits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.core import Record, StoreError
from lifelore.memory import folding
from lifelore.memory.contribution import Contribution
from lifelore.memory.folding import Stored, fold
from lifelore.memory.record_blob import pack
from lifelore.memory.record_rules import checked_records

cells = st.dictionaries(
    st.integers(-3, 3) | st.sampled_from([2**63 - 1, -(2**63)]), st.integers(-9, 9), max_size=5
)
NAME = ("k", "y", 1)


def stored(parts: list[dict[int, int]], merge: str) -> list[Stored]:
    columns = [(np.array(list(part), dtype=np.int64), np.array(list(part.values()))) for part in parts]
    made = [Record(*NAME, merge, slots, values) for slots, values in columns]
    blobs = [pack(checked_records([record])) for record in made]
    return [
        Stored(100 + seq, Contribution.packed(("r", "p", seq), 1, "{}", blob)) for seq, blob in enumerate(blobs)
    ]


def naive(parts: list[dict[int, int]], merge: str) -> dict[int, tuple[int, int]]:
    """Value and number of the last contribution, slot by slot."""
    found: dict[int, tuple[int, int]] = {}
    for seq, part in enumerate(parts):
        for slot, value in part.items():
            old = found[slot][0] if slot in found else None
            rules = {"add": lambda a, b: a + b, "union": max, "newest": lambda a, b: b}
            found[slot] = (value if old is None else rules[merge](old, value), 100 + seq)
    return found


@pytest.mark.slow
@pytest.mark.parametrize("at_a_time", [1, 2, 64])
@pytest.mark.parametrize("merge", ["add", "union", "newest"])
@given(parts=st.lists(cells, min_size=1, max_size=6))
def test_folding_agrees_with_a_dictionary(at_a_time, merge, parts):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(folding, "_AT_A_TIME", at_a_time)
        folded = fold(stored(parts, merge))[NAME]
    expected = sorted(naive(parts, merge).items())
    assert folded.slots.tolist() == [slot for slot, _ in expected]
    assert folded.values.tolist() == [value for _, (value, _) in expected]
    assert folded.origins.tolist() == [origin for _, (_, origin) in expected]
    assert folded.mentions == [100 + seq for seq in range(len(parts))]
    assert folded.origin == 99 + len(parts)


@pytest.mark.slow
@given(st.lists(st.integers(-(2**63), 2**63 - 1), min_size=1, max_size=6))
def test_sums_are_exact_or_refused(numbers):
    parts = stored([{1: number} for number in numbers], "add")
    if -(2**63) <= sum(numbers) < 2**63:
        assert fold(parts)[NAME].values.tolist() == [sum(numbers)]
    else:
        with pytest.raises(StoreError, match="64 bits"):
            fold(parts)


def test_only_the_keys_asked_for():
    assert fold(stored([{1: 1}], "add"), only={("k", "other", 1)}) == {}


def test_two_merges_of_one_key_are_refused():
    with pytest.raises(StoreError, match="add and by newest"):
        fold(stored([{1: 1}], "add") + stored([{1: 1}], "newest"))
