"""The reason for a claim's verdict in one clause: ``reason`` of its ``claim.toml``, with numbers of its result.

The clause names measures in braces: ``{greedy_of_optimal}`` becomes the number in three digits, ``{share:%}``
whole percents. So no number of it is typed by hand, and a new run changes it.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from reproduction.engine.claim import Claim
from reproduction.engine.condition_table import measured_now
from reproduction.engine.predicate import short


class _Number:
    def __init__(self, value: float | None) -> None:
        self._value = value

    def __format__(self, style: str) -> str:
        if self._value is None:
            return "no number"
        return f"{100 * self._value:.0f}\u00a0%".replace("-", "−") if style == "%" else short(self._value)


def reason_in_words(claim: Claim, result: Mapping) -> str:
    """The clause; empty for a claim without one.

    Raises
    ------
    InputError
        It names a measure that the result does not have.
    """
    numbers = {name: _Number(number["value"]) for name, number in measured_now(result).items()}
    try:
        return claim.reason.format_map(numbers)
    except KeyError as error:
        raise InputError(f"reason of {claim.id} must name measures of its result, got {error}") from None
