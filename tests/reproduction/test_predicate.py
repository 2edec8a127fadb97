"""Verdicts from conditions, by hand."""

import pytest

from lifelore.core.errors import InputError
from reproduction.engine.predicate import (
    FAILS,
    HOLDS,
    IN_PART,
    UNTESTED,
    Condition,
    Predicate,
    Rule,
    number_in_words,
    short,
)


def number(value, ci95=None, n=9):
    return {"value": value, "median": value, "ci95": ci95, "n": n}


@pytest.mark.parametrize(
    ("part", "op", "bound", "value", "ci95", "answer"),
    [
        ("value", ">", 0, 0.1, [-1, 1], True),
        ("value", ">", 0, 0.0, None, False),
        ("value", ">=", 0, 0.0, None, True),
        ("value", "<", 1, 1.0, None, False),
        ("value", "<=", 1, 1.0, None, True),
        ("value", "between", (1, 2), 2.0, None, True),
        ("value", "between", (1, 2), 2.1, None, False),
        ("interval", ">", 0, 0.5, [0.1, 0.9], True),
        ("interval", ">", 0, 0.5, [-0.1, 0.9], False),
        ("interval", "<", 1, 0.5, [0.1, 1.1], False),
        ("interval", "between", (-1, 1), 5.0, [-1, 1], True),
        ("interval", ">", 0, 0.5, None, None),
        ("value", ">", 0, None, None, None),
        ("value", ">", 0, float("nan"), None, None),
    ],
)
def test_condition(part, op, bound, value, ci95, answer):
    condition = Condition("c", "x", part, op, bound, "x is so")
    assert condition.met({"x": number(value, ci95)}) is answer


def test_condition_on_a_number_that_was_not_measured_cannot_be_told():
    assert Condition("c", "x", "value", ">", 0, "x is so").met({}) is None


def two(rules=None):
    conditions = (
        Condition("a", "x", "value", ">", 0, "x is positive"),
        Condition("b", "y", "value", ">", 0, "y is positive"),
    )
    return Predicate(conditions, rules or (Rule(HOLDS, ("a", "b")), Rule(IN_PART, (), ("a", "b"))))


@pytest.mark.parametrize(
    ("x", "y", "verdict"),
    [
        (1, 1, HOLDS),
        (1, -1, IN_PART),
        (-1, 1, IN_PART),
        (-1, -1, FAILS),
        (1, None, UNTESTED),
        (-1, None, UNTESTED),
    ],
)
def test_verdict(x, y, verdict):
    assert two().verdict({"x": number(x), "y": number(y)}) == verdict


def test_rule_with_both_lists_needs_all_of_one_and_some_of_the_other():
    rule = Rule(HOLDS, ("a",), ("b", "c"))
    assert rule.met({"a": True, "b": False, "c": True})
    assert not rule.met({"a": True, "b": False, "c": False})
    assert not rule.met({"a": False, "b": True, "c": True})


def test_why_gives_numbers_and_likely_causes_of_what_is_not_met():
    measured = {"x": number(1.0, [0.5, 1.5]), "y": number(-2.0)}
    why = two().why(measured, {"a": "never said", "b": "y was small"})
    assert why == (
        "Met: x is positive (1 [0.5, 1.5], n 9). Not met: y is positive (−2, n 9), likely because y was small."
    )
    assert two().why({"x": number(1.0)}).endswith("Cannot be told: y is positive (not measured).")


@pytest.mark.parametrize(
    "rules", [(Rule("perhaps", ("a",)),), (Rule(HOLDS, ("z",)),), (Rule(HOLDS),)], ids=["verdict", "name", "empty"]
)
def test_rules_that_cannot_decide_are_refused(rules):
    with pytest.raises(InputError, match="rule must name"):
        two(rules)


def test_conditions_are_checked():
    with pytest.raises(InputError, match="op must be one of"):
        Condition("c", "x", "value", "!=", 0, "")
    same = Condition("c", "x", "value", ">", 0, "")
    with pytest.raises(InputError, match="different names"):
        Predicate((same, same), ())


@pytest.mark.parametrize(
    ("x", "text"),
    [
        (0, "0"),
        (1234567, "1,234,567"),
        (-0.12345, "−0.123"),
        (99.96, "100"),
        (5, "5"),
        (0.001234, "0.00123"),
        (150, "150"),
    ],
)
def test_short_numbers(x, text):
    assert short(x) == text


def test_number_in_words():
    assert number_in_words(number(1.0, [0.25, 2])) == "1 [0.25, 2], n 9"
    assert number_in_words(number(None)) == "no finite value, n 9"
