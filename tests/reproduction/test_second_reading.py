"""The second reading of a verdict, by hand."""

import pytest

from lifelore.core.errors import InputError
from reproduction.engine.predicate import FAILS, HOLDS, IN_PART, UNTESTED, Condition, Predicate
from reproduction.engine.second_reading import (
    MISSING,
    NO,
    OPEN,
    UNDECIDED,
    YES,
    ReadCondition,
    SecondReading,
)


def number(value, ci95=None):
    return {"value": value, "median": value, "ci95": ci95, "n": 9}


def condition(name, op=">", bound=0.0):
    return Condition(name, name, "interval", op, bound, f"{name} is so")


@pytest.mark.parametrize(
    ("op", "bound", "value", "ci95", "exact", "answer"),
    [
        (">", 0, 0.5, [0.1, 0.9], False, YES),
        (">", 0, 0.5, [-0.1, 0.9], False, OPEN),
        (">", 0, -0.5, [-0.9, 0.0], False, NO),
        ("<=", 1, 1.0, [0.9, 1.0], False, YES),
        ("<=", 1, 1.5, [1.1, 2.0], False, NO),
        ("between", (1, 2), 1.5, [1.2, 1.8], False, YES),
        ("between", (1, 2), 1.5, [0.9, 2.1], False, OPEN),
        ("between", (1, 2), 1.9, [1.8, 2.1], False, OPEN),
        ("between", (1, 2), 2.5, [2.1, 3.0], False, NO),
        ("between", (1, 2), 0.5, [0.1, 0.9], False, NO),
        (">", 0, 0.5, None, False, MISSING),
        (">", 0, 0.5, None, True, YES),
        (">", 0, -0.5, None, True, NO),
        (">", 0, 0.5, [-0.1, 0.9], True, OPEN),
        (">", 0, None, None, True, MISSING),
        (">", 0, 0.5, [0.1, float("nan")], False, MISSING),
    ],
)
def test_the_whole_interval_answers(op, bound, value, ci95, exact, answer):
    one = ReadCondition("headline", condition("a", op, bound), exact)
    assert one.answer({"a": number(value, ci95)}) == answer


SURE, UNSURE, FALSE = [0.2, 0.4], [-0.1, 0.4], [-0.4, -0.2]


@pytest.mark.parametrize(
    ("headline", "printed", "share", "verdict"),
    [
        (SURE, SURE, 0.9, HOLDS),
        (SURE, FALSE, 0.9, IN_PART),
        (SURE, SURE, 0.4, IN_PART),
        (SURE, UNSURE, 0.9, UNDECIDED),
        (SURE, UNSURE, 0.4, IN_PART),
        (UNSURE, SURE, 0.9, UNDECIDED),
        (FALSE, SURE, 0.9, IN_PART),
        (FALSE, SURE, 0.3, IN_PART),
        (FALSE, SURE, 0.2, FAILS),
        (None, SURE, 0.9, UNTESTED),
    ],
)
def test_verdicts(headline, printed, share, verdict):
    reading = SecondReading(
        "why",
        (
            ReadCondition("headline", condition("sentence")),
            ReadCondition("printed", condition("number")),
            ReadCondition("grid", condition("share", bound=0.5), exact=True),
            ReadCondition("own", condition("extra")),
        ),
        minority=0.25,
    )
    measured = {"sentence": number(0.1, headline), "number": number(0.1, printed), "share": number(share)}
    assert reading.verdict(measured) == verdict
    assert "sentence is so" in reading.said(measured)
    assert "extra" not in reading.said(measured)


def test_extras_and_details_never_count():
    reading = SecondReading(
        "why",
        (
            ReadCondition("headline", condition("a")),
            ReadCondition("detail", condition("b")),
            ReadCondition("own", condition("c")),
        ),
    )
    assert reading.verdict({"a": number(1, SURE), "b": number(1, FALSE)}) == HOLDS
    assert reading.verdict({"a": number(1, FALSE), "b": number(1, SURE), "c": number(1, SURE)}) == FAILS


def test_a_condition_of_the_first_reading_is_taken_over_and_data_go_round():
    first = Predicate.from_data(
        {
            "conditions": [
                {
                    "name": "a",
                    "measure": "x",
                    "part": "value",
                    "op": "between",
                    "bound": [0, 1],
                    "words": "x is so",
                }
            ],
            "rules": [{"verdict": "holds", "all": ["a"]}],
        }
    )
    data = {
        "why": "because",
        "conditions": [
            {"role": "headline", "first": "a"},
            {"role": "own", "name": "b", "measure": "y", "op": ">", "bound": 2, "words": "y is so", "exact": True},
        ],
    }
    reading = SecondReading.from_data(data, first)
    assert reading.conditions[0].condition is first.conditions[0]
    assert reading.measures == {"x", "y"}
    assert SecondReading.from_data(reading.to_data(), first).to_data() == reading.to_data()


@pytest.mark.parametrize(
    ("conditions", "rule"),
    [
        ([{"role": "headline", "first": "b"}], "must name a condition of the first reading"),
        ([{"role": "main", "first": "a"}], "role must be one of headline"),
        ([{"role": "own", "first": "a"}], "with a headline among them"),
        ([{"role": "headline", "name": "b"}], "a condition must have bound, measure"),
    ],
)
def test_what_is_refused(conditions, rule):
    first = Predicate.from_data(
        {
            "conditions": [
                {"name": "a", "measure": "x", "part": "value", "op": ">", "bound": 0, "words": "x is so"}
            ],
            "rules": [{"verdict": "holds", "all": ["a"]}],
        }
    )
    with pytest.raises(InputError, match=rule):
        SecondReading.from_data({"why": "because", "conditions": conditions}, first)
