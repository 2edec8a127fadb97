"""Statements of a claim's sentence, their three marks, and the claim's word.

A statement asks one measured number: ``holds = "first_return > 0"``, or ``"share in [0.65, 0.8]"``. Its marks tell
where it holds: at the default, under some reasonable reading, and under most of them. The readings are the grid of
choices that the thesis leaves open; without a grid there is only the default.
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from lifelore.core.errors import InputError

YES, HALF, NO, MISSING = "✓", "½", "✗", "–"
"""Marks; `HALF` at the default: it holds on average, but the 95 % interval spans the bound (more runs needed)."""
REPRODUCED, DIRECTION, OPEN_CHOICE, FAILS, IN_ERROR, UNTESTED = WORDS = (
    "reproduced", "direction reproduced, number not", "depends on an open choice", "not reproduced",
    "thesis in error", "cannot be tested",
)  # fmt: skip
MOST, MANY = 0.5, 0.25
"""Shares of the readings above which a statement holds under most of them, or half does."""
OPS = {
    ">": lambda x, bound: x > bound,
    ">=": lambda x, bound: x >= bound,
    "<": lambda x, bound: x < bound,
    "<=": lambda x, bound: x <= bound,
    "in": lambda x, bound: bound[0] <= x <= bound[1],
}
_HOLDS = re.compile(r"(\w+) (>=|<=|>|<|in) (.+)")

Measured = Mapping[str, Mapping]
"""Plain numbers by name, each {"value", "median", "ci95", "n"}."""


@dataclass(frozen=True)
class Statement:
    """One statement: what it says in a few words, and the condition on a measured number that makes it true.

    Parameters
    ----------
    says : str
    measure, op : str
    bound : float or pair of float
        A pair belongs to the operator ``in``, both ends included.
    central : bool
        Whether the claim's word rests on it; other statements are printed numbers and remarks.
    """

    says: str
    measure: str
    op: str
    bound: float | tuple[float, float]
    central: bool = False

    @classmethod
    def parsed(cls, says: str, holds: str, central: bool = False) -> "Statement":
        """From its words in ``claim.toml``.

        Examples
        --------
        >>> Statement.parsed("first return is positive", "first > 0")
        Statement(says='first return is positive', measure='first', op='>', bound=0.0, central=False)
        """
        try:
            measure, op, bound = _HOLDS.fullmatch(holds.strip()).groups()  # type: ignore[union-attr]
            ends = [float(end) for end in bound.strip("[]").split(",")]
            (low, high) = ends if op == "in" else (*ends, None)
        except (AttributeError, ValueError):
            raise InputError(
                f"holds of '{says}' must read like 'measure > 0' or 'measure in [0, 1]', got '{holds}'"
            ) from None
        return cls(says, measure, op, low if high is None else (low, high), central)

    def mark(self, measured: Measured) -> str:
        """`YES` by the whole 95 % interval, `HALF` by the value alone, else `NO`."""
        number = measured.get(self.measure, {})
        asked = [number.get("value"), *(number.get("ci95") or ())]
        finite = [x for x in asked if x is not None and math.isfinite(x)]
        if len(finite) < len(asked):
            return MISSING
        met = [OPS[self.op](x, self.bound) for x in finite]
        return YES if all(met) else HALF if met[0] else NO

    def marks(self, measured: Measured, readings: Sequence[Measured]) -> str:
        """Three marks: at the default, under some reading, under most."""
        default = self.mark(measured)
        found = [self.mark(reading) for reading in readings if self.measure in reading]
        if default == MISSING or not found:
            return default * 3
        share = found.count(YES) / len(found)
        some = YES if YES in (default, *found) else HALF if HALF in (default, *found) else NO
        return default + some + (YES if share > MOST else HALF if share >= MANY else NO)


def word_of(statements: Sequence[Statement], marks: Sequence[str], in_error: bool) -> str:
    """The claim's word, from the marks of its central statements, and of all at the default.

    *Reproduced*: all hold, the central ones not only under few readings. *Depends on an open choice*: every
    central one holds under some reading. *Direction reproduced*: at least half of the central ones hold.
    `in_error`: an erratum shows that the thesis's formula or proof is wrong.
    """
    default, some, most = zip(*(of for one, of in zip(statements, marks, strict=True) if one.central), strict=True)
    if any(MISSING in of for of in marks):
        return UNTESTED
    if in_error:
        return IN_ERROR
    if NO not in default and NO not in most:
        return REPRODUCED if all(of[0] == YES for of in marks) else DIRECTION
    if set(some) == {YES}:
        return OPEN_CHOICE
    return DIRECTION if 2 * default.count(NO) <= len(default) else FAILS


def number_in_words(number: Mapping) -> str:
    """An estimate as people read it: ``1.23 [1.10, 1.31]``."""
    if number["value"] is None:
        return "no number"
    ends = f" [{', '.join(short(x) for x in number['ci95'])}]" if number["ci95"] else ""
    return short(number["value"]) + ends


def short(x: float, significant: int = 3) -> str:
    """A number to so many significant digits, without an exponent from 0.001 to a million."""
    if x == 0 or not math.isfinite(x):
        return "0" if x == 0 else str(x)
    digits = max(0, significant - 1 - math.floor(math.log10(abs(x))))
    text = f"{x:,.{digits}f}" if digits <= significant + 2 else f"{x:.{significant - 1}e}"
    return (text.rstrip("0").rstrip(".") if "." in text and "e" not in text else text).replace("-", "−")


def filled(words: str, measured: Measured) -> str:
    """Words with numbers for measures in braces: ``{gain}`` to three digits, ``{share:%}`` in whole percents.

    Raises
    ------
    InputError
        A measure in braces was not measured.
    """
    try:
        return words.format_map({name: _Number(number["value"]) for name, number in measured.items()})
    except KeyError as error:
        raise InputError(f"'{words}' must name measures of the result, got {error}") from None


class _Number:
    def __init__(self, value: float | None) -> None:
        self._value = value

    def __format__(self, style: str) -> str:
        if self._value is None:
            return "no number"
        if style == "%":
            return f"{100 * self._value:.0f}\u00a0%".replace("-", "−")
        return short(self._value, int(style) if style else 3)
