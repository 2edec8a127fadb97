"""Conditions and numbers in words: enough digits to see whether a condition is met."""

import pytest

from reproduction.engine.condition_table import bounds_in_words, measured_in_words
from reproduction.engine.predicate import Condition


@pytest.mark.parametrize(
    ("op", "bound", "value", "asked", "measured"),
    [
        ("<=", 1.0, 1.234, "at most 1", "1.23 [0.5, 2], n 9"),
        (">=", 0.95, 0.94996, "at least 0.95", "0.94996 [0.5, 2], n 9"),
        ("between", (1.38625, 1.38635), 1.38629, "between 1.38625 and 1.38635", "1.38629 [0.5, 2], n 9"),
        ("between", (0, 0), 0, "exactly 0", "0 [0.5, 2], n 9"),
        (">", 0.5, 0.5, "above 0.5", "0.5 [0.5, 2], n 9"),
        (">", 0.5, 0.5 + 1e-12, "above 0.5", "0.5 [0.5, 2], n 9"),
        (">", 0.5, None, "above 0.5", "no finite value, n 9"),
    ],
)
def test_a_value_that_differs_from_its_bound_reads_differently(op, bound, value, asked, measured):
    condition = Condition("it", "number", "value", op, bound, "it is so")
    found = {"number": {"value": value, "ci95": [0.5, 2], "n": 9}}
    assert (bounds_in_words(condition, found), measured_in_words(condition, found)) == (asked, measured)


def test_a_condition_that_was_not_measured():
    condition = Condition("it", "number", "value", ">", 0.5, "it is so")
    assert (bounds_in_words(condition, {}), measured_in_words(condition, {})) == ("above 0.5", "–")
