"""Marks and words of statements, worked by hand."""

import pytest

from lifelore.core.errors import InputError
from reproduction.engine.statement import (
    DIRECTION,
    FAILS,
    IN_ERROR,
    OPEN_CHOICE,
    REPRODUCED,
    UNTESTED,
    Statement,
    filled,
    number_in_words,
    short,
    word_of,
)


def number(value, low=None, high=None):
    return {"value": value, "median": value, "ci95": None if low is None else [low, high], "n": 10}


def statement(holds, central=True):
    return Statement.parsed("it holds", holds, central)


@pytest.mark.parametrize(
    ("holds", "measured", "mark"),
    [
        ("x > 0", number(1, 0.5, 2), "✓"),
        ("x > 0", number(1, -0.5, 2), "½"),
        ("x > 0", number(-1, -2, 0.5), "✗"),  # not on average either
        ("x > 0", number(-1, -2, -0.5), "✗"),
        ("x > 0", number(0, 0, 0), "✗"),
        ("x >= 0", number(0, 0, 0), "✓"),
        ("x < 0.5", number(0.4), "✓"),
        ("x <= 0.5", number(0.6), "✗"),
        ("x in [1, 2]", number(1.5, 1.2, 1.8), "✓"),
        ("x in [1, 2]", number(1.5, 0.8, 1.8), "½"),
        ("x in [1, 2]", number(1.5, 0.8, 2.8), "½"),
        ("x in [1, 2]", number(3, 2.5, 3.5), "✗"),
        ("x > 0", number(None), "–"),
        ("x > 0", number(1, 0.5, float("inf")), "–"),
    ],
)
def test_a_statement_is_answered_by_its_whole_interval(holds, measured, mark):
    assert statement(holds).mark({"x": measured}) == mark


def test_a_measure_that_is_missing_has_no_mark():
    assert statement("x > 0").marks({"y": number(1)}, []) == "–––"


@pytest.mark.parametrize(
    ("readings", "marks"),
    [
        ([], "✓✓✓"),
        ([1, 1, -1], "✓✓✓"),
        ([1, -1], "✓✓½"),  # just half is not most
        ([1, -1, -1, -1], "✓✓½"),
        ([1, -1, -1, -1, -1], "✓✓✗"),
    ],
)
def test_some_and_most_count_the_readings(readings, marks):
    measured = [{"x": number(x)} for x in readings]
    assert statement("x > 0").marks({"x": number(1)}, measured) == marks


def test_a_reading_without_the_measure_does_not_count():
    assert statement("x > 0").marks({"x": number(-1)}, [{"y": number(1)}, {"x": number(1)}]) == "✗✓✓"


@pytest.mark.parametrize(
    ("central", "other", "word"),
    [
        (["✓✓✓", "✓✓✓"], ["✓✓✓"], REPRODUCED),
        (["✓✓½"], [], REPRODUCED),
        (["✓✓✓"], ["✗✗✗"], DIRECTION),
        (["✓✓✓", "½✓✓"], [], DIRECTION),
        (["✓✓✗"], [], OPEN_CHOICE),
        (["✗✓✓"], [], OPEN_CHOICE),
        (["✓✓✓", "✗✓✗"], ["✓✓✓"], OPEN_CHOICE),
        (["✓✓✓", "✗✗✗"], [], DIRECTION),  # half of the sentence is found
        (["✓✓✓", "✗½✗"], [], DIRECTION),
        (["✓✓✓", "✗½✗", "✗✗✗"], [], FAILS),
        (["✗½✗"], [], FAILS),
        (["✓✓✓"], ["–––"], UNTESTED),
    ],
)
def test_the_word_follows_from_the_central_marks(central, other, word):
    statements = [statement("x > 0")] * len(central) + [statement("x > 0", central=False)] * len(other)
    assert word_of(statements, [*central, *other], in_error=False) == word


def test_a_formal_error_of_the_thesis_has_its_own_word():
    assert word_of([statement("x > 0")], ["✗✗✗"], in_error=True) == IN_ERROR


@pytest.mark.parametrize("holds", ["x", "x > many", "x in [1]", "x = 1", "two words > 1"])
def test_conditions_that_cannot_be_read(holds):
    with pytest.raises(InputError, match="holds of 'it holds' must read like 'measure > 0'"):
        statement(holds)


def test_numbers_in_words():
    assert number_in_words(number(1.2345, -0.5, 23456.7)) == "1.23 [−0.5, 23,457]"
    assert number_in_words(number(None)) == "no number"
    assert [short(x) for x in (0.0, 0.000123, 1234567.0, -2.0)] == ["0", "1.23e−04", "1,234,567", "−2"]


def test_words_are_filled_with_measures():
    measured = {"gain": number(0.12345), "share": number(0.756), "none": number(None)}
    assert filled("{gain} {gain:2} {share:%} {none}", measured) == "0.123 0.12 76\u00a0% no number"
    with pytest.raises(InputError, match="must name measures of the result, got 'loss'"):
        filled("{loss}", measured)
