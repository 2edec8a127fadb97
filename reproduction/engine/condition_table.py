"""The conditions of a claim as a Markdown table: asked, measured, and whether met."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from reproduction.engine.claim import Claim
from reproduction.engine.predicate import HOLDS, Condition, number_in_words, short
from reproduction.engine.second_reading import GRID, HEADLINE, MISSING, NO, OPEN, PRINTED, YES

MOST_DIGITS = 7
"""Significant digits; more show differences that rounding errors make."""
OPS = {">": "above", ">=": "at least", "<": "below", "<=": "at most", "between": "between"}
ANSWERS = {True: YES, False: NO, None: MISSING}
MET = {YES: "yes", NO: "**no**", OPEN: "open", MISSING: "not measured"}
COUNTED = (HEADLINE, PRINTED, GRID)
"""Roles that the verdict of a second reading counts, by weight."""


class Row(NamedTuple):
    """A condition with its place among those of its reading, from 1, and its answer."""

    number: int
    role: str
    condition: Condition
    asked: str
    answer: str


def measured_now(result: Mapping) -> dict[str, Mapping]:
    """The numbers of a result, those pooled over seeds in place of the first seed's."""
    return {**result["measured"], **(result.get("seeds") or {}).get("pooled", {})}


def counted_rows(claim: Claim, result: Mapping) -> list[Row]:
    """The conditions that decide: of the second reading where there is one, else those of the first."""
    measured = measured_now(result)
    if claim.second and result.get("second"):
        return [row for row in second_rows(claim, measured) if row.role in COUNTED]
    asked = {name for rule in claim.predicate.rules if rule.verdict == HOLDS for name in rule.all_of + rule.any_of}
    return [row for row in first_rows(claim, measured) if row.condition.name in asked]


def second_rows(claim: Claim, measured: Mapping) -> list[Row]:
    """All conditions of the second reading."""
    conditions = claim.second.conditions if claim.second else ()
    return [
        Row(n, one.role, one.condition, bounds_in_words(one.condition, measured), one.answer(measured))
        for n, one in enumerate(conditions, 1)
    ]


def first_rows(claim: Claim, measured: Mapping) -> list[Row]:
    """All conditions of the first reading."""
    return [
        Row(n, HEADLINE, c, _asked(c, measured), ANSWERS[c.met(measured)])
        for n, c in enumerate(claim.predicate.conditions, 1)
    ]


def condition_table(
    rows: Sequence[Row], words: Mapping[Row, str], measured: Mapping, n: bool = False, roles: bool = True
) -> list[str]:
    """The rows that have words, with the sample sizes where `n` is true; a line says how many have none."""
    heads = ["", *(["counts as"] if roles else []), "condition", "asked", "measured [95\u00a0%]", "met"]
    lines = [table_line(heads), "|" + "---|" * len(heads)]
    for row in rows:
        if row in words:
            number = measured_in_words(row.condition, measured)
            number = number if n else number.partition(", n ")[0]
            role = [row.role] if roles else []
            lines.append(table_line([str(row.number), *role, words[row], row.asked, number, MET[row.answer]]))
    left = len(rows) - len(words)
    return [*(lines if words else []), "", *([f"{left} more below.", ""] if left else [])]


def table_line(cells: Sequence[str]) -> str:
    """A line of a Markdown table; a bar within a cell is no border."""
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def measured_in_words(condition: Condition, measured: Mapping) -> str:
    """The number that a condition asks of; a dash where there is none."""
    number = measured.get(condition.measure)
    if not number or not number["n"]:
        return "–"
    return number_in_words(number, _significant(condition, number))


def bounds_in_words(condition: Condition, measured: Mapping) -> str:
    """What is asked of the number: ``above 0.5``."""
    bounds = _bounds(condition)
    digits = _significant(condition, measured.get(condition.measure))
    words = dict.fromkeys(short(bound, digits) for bound in bounds)
    return f"{OPS[condition.op] if len(words) == len(bounds) else 'exactly'} {' and '.join(words)}"


def _asked(condition: Condition, measured: Mapping) -> str:
    words = bounds_in_words(condition, measured)
    return f"interval {words}" if condition.part == "interval" else words


def _bounds(condition: Condition) -> tuple[float, ...]:
    return condition.bound if isinstance(condition.bound, tuple) else (condition.bound,)


def _significant(condition: Condition, number: Mapping | None) -> int:
    """Significant digits, 3 or more, at which the value and the bounds read differently where they differ."""
    value = () if number is None or number["value"] is None else (number["value"],)
    different = {*_bounds(condition), *value}
    return next(
        (n for n in range(3, MOST_DIGITS) if len({short(x, n) for x in different}) == len(different)), MOST_DIGITS
    )
