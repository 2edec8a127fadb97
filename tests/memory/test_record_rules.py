import numpy as np
import pytest

from lifelore.core import InputError, Record
from lifelore.memory.record_rules import checked_record, checked_records


def make(**changes):
    fields = {"kind": "k", "key": "y", "version": 1, "merge": "add", "slots": np.array([2, 1]),
              "values": np.array([20, 10]), "about": {}}  # fmt: skip
    return Record(**(fields | changes))


def test_arrays_are_sorted_by_slot():
    record = checked_record(make())
    assert record.slots.tolist() == [1, 2]
    assert record.values.tolist() == [10, 20]


@pytest.mark.parametrize("kind", [np.int8, np.uint32, np.int64])
def test_whole_numbers_that_fit_are_taken(kind):
    record = checked_record(make(values=np.array([3, 4], dtype=kind)))
    assert record.values.dtype == np.int64


@pytest.mark.parametrize(
    ("key", "values", "rule"),
    [
        ("kind", ("",), "record.kind must be 1 to 200 printable"),
        ("key", ("x" * 201, "a\nb", "a\0b", "\ud800"), "record.key"),
        ("version", (-1, 1.0, True, 2**63), "version must be a whole number"),
        ("merge", ("mean",), "merge must be one of add, newest, union"),
        ("slots", (np.array([1, 1]),), "slots must be unique"),
        ("slots", (np.array([1]),), "equally long, got 1 and 2"),
        ("slots", (np.array([[1, 2]]),), r"one-dimensional int64 array, got shape \(1, 2\)"),
        ("values", (np.array([1.0, 2.0]), np.array([1, 2], np.uint64), np.array([True, False])),
         "values must be a one-dimensional int64"),
        ("about", ({"x": float("nan")}, {"x": np.int64(3)}, {1: 2, "a": 3}), "about must hold plain JSON"),
    ],
)  # fmt: skip
def test_what_breaks_a_rule_is_named(key, values, rule):
    for value in values:
        with pytest.raises(InputError, match=rule) as refused:
            checked_record(make(**{key: value}))
        assert "\n" not in str(refused.value)


def test_one_contribution_has_each_key_once():
    with pytest.raises(InputError, match="twice"):
        checked_records([make(), make()])


@pytest.mark.parametrize("changes", [{"robot": " \t"}, {"robot": 3}, {"process": ""}, {"seq": -1}, {"seq": 2**63},
                                     {"seq": "0"}, {"task": {"x": {1, 2}}}])  # fmt: skip
def test_names_around_a_record_have_rules_too(changes, memory):
    fields = {"robot": "r", "process": "p", "seq": 0, "task": {}} | changes
    with pytest.raises(InputError, match=next(iter(changes))):
        memory.contribute(fields.pop("robot"), [make()], **fields)
