"""Labels to ids: the two conventions, and how they are told apart."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.perception.clouds.label_rule import MAX_OBJECTS, ids_from_labels


def ids(labels: list, rule: str = "auto", dtype: type = np.int64) -> list[int]:
    return ids_from_labels(np.array(labels, dtype), rule).tolist()


@pytest.mark.parametrize("dtype", [np.uint8, np.int16, np.uint32, np.uint64, np.float32, np.float64])
def test_parts_merge_whatever_the_numbers_are_stored_as(dtype: type) -> None:
    assert ids([0, 1, 2, 20, 21, 30, 53], dtype=dtype) == [0, 1, 1, 2, 2, 3, 5]


@pytest.mark.parametrize(
    ("labels", "expected"),
    [
        ([0, 1, 2, 3], [0, 1, 2, 3]),
        ([2, 12, 20, 21], [2, 12, 20, 21]),  # 12 is no part of anything
        ([1, 30, 31, 40], [1, 30, 31, 40]),  # nothing in 20–29
        ([1, 21, 34, 57], [1, 21, 34, 57]),  # no object has a first part
        ([1, 20, 31], [1, 2, 3]),  # half of them do
        ([0, 0], [0, 0]),
    ],
)
def test_auto_by_the_rule(labels: list[int], expected: list[int]) -> None:
    assert ids(labels) == expected


@settings(deadline=None)
@given(st.lists(st.sampled_from([0, 1, 2, 5, 10**6, 10**9]), max_size=12))
def test_large_labels_and_small_ones_are_kept_alike(labels: list[int]) -> None:
    assert ids(labels, "plain") == labels


@given(st.integers(2, 60))
def test_objects_numbered_without_a_gap_are_never_merged(n: int) -> None:
    assert ids(list(range(n + 1))) == list(range(n + 1))


@settings(deadline=None)
@given(st.lists(st.integers(1, 5), min_size=1, max_size=9))
def test_every_file_with_parts_counted_from_zero_is_merged(parts: list[int]) -> None:
    labels = [10 * (k + 2) + part for k, n in enumerate(parts) for part in range(n)]
    assert ids([0, 1, *labels]) == [0, 1, *(label // 10 for label in labels)]


def test_a_given_rule_is_obeyed() -> None:
    assert ids([1, 20, 21], "plain") == [1, 20, 21]
    assert ids([1, 31, 32], "parts") == [1, 3, 3]


def test_negative_and_missing_labels_are_nothing() -> None:
    assert ids([-1, 2]) == [0, 2]
    assert ids([np.nan, 2.0], dtype=np.float32) == [0, 2]


@pytest.mark.parametrize(
    ("labels", "rule", "said"),
    [
        (np.array([1, 2]), "auot", "labels must be one of auto, plain, parts"),
        (np.array([1.5]), "auto", "whole numbers"),
        (np.array([np.inf]), "auto", "whole numbers"),
        (np.array([2**63], np.uint64), "auto", "2\\^53"),
        (np.array(["a"]), "auto", "must be numbers"),
        (np.array([12, 20]), "parts", "labels=plain"),
        (np.arange(2, MAX_OBJECTS + 3), "auto", f"{MAX_OBJECTS + 1} objects"),
    ],
)
def test_what_cannot_be_labels_is_refused(labels: np.ndarray, rule: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        ids_from_labels(labels, rule)
