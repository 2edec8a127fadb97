"""The reason for a verdict takes its numbers from the result."""

from types import SimpleNamespace

import pytest

from lifelore.core.errors import InputError
from reproduction.engine.reason import reason_in_words


def reason(text, **numbers):
    measured = {name: {"value": value, "ci95": None, "n": 1} for name, value in numbers.items()}
    return reason_in_words(SimpleNamespace(id="C0.0", reason=text), {"measured": measured})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("it takes {ratio} times as long", "it takes 1.23 times as long"),
        ("{share:%} of tasks", "38\u00a0% of tasks"),
        ("less by {loss:%}", "less by −5\u00a0%"),
        ("nothing is known", "nothing is known"),
        ("{empty} at {empty:%}", "no number at no number"),
    ],
)
def test_numbers_in_words(text, words):
    assert reason(text, ratio=1.2345, share=0.3812, loss=-0.05, empty=None) == words


def test_a_measure_that_the_result_does_not_have():
    with pytest.raises(InputError, match=r"reason of C0\.0 must name measures of its result, got 'other'"):
        reason("{other}", ratio=1.0)


def test_pooled_numbers_come_first():
    result = {"measured": {"x": {"value": 1.0}}, "seeds": {"pooled": {"x": {"value": 2.0}}}}
    claim = SimpleNamespace(id="C0.0", reason="{x}")
    assert reason_in_words(claim, result) == "2"  # type: ignore[arg-type]
