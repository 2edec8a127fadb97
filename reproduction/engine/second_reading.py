"""A second reading of a claim: one meaning of each verdict for all claims, beside the rules that were filed first.

Each condition has a role:

- ``headline``: what the thesis's sentence says, in its own terms;
- ``printed``: a number that the thesis prints;
- ``grid``: the share of the choices left open in which the headline, or a part of it, holds;
- ``detail`` and ``own``: what else the thesis says, and our own extras; shown, never counted.

A condition is answered by the whole 95 % interval: yes, no, or open where the interval spans the bound. Only a
number that is exact may do without an interval (``exact = true``). The verdict:

- *holds*: every headline, printed number and grid says yes;
- *holds in part*: every headline says yes, and a printed number or the grid says no; or a headline says no at the
  default, and the headline holds in more of the grid than the stated ``minority``;
- *undecided*: a condition that could decide is open; more runs may tell;
- *does not hold*: otherwise;
- *cannot be tested*: a number is missing.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from lifelore.core.errors import InputError
from reproduction.engine.predicate import (
    FAILS,
    HOLDS,
    IN_PART,
    OPS,
    UNTESTED,
    Condition,
    Measured,
    Predicate,
    number_in_words,
)

UNDECIDED = "undecided"
SECOND_VERDICTS = (HOLDS, IN_PART, FAILS, UNDECIDED, UNTESTED)
HEADLINE, PRINTED, GRID, DETAIL, OWN = ROLES = ("headline", "printed", "grid", "detail", "own")
YES, NO, OPEN, MISSING = ANSWERS = ("yes", "no", "open", "missing")
MINORITY = 0.1
"""Share of the grid above which a headline that fails at the default holds in part."""
_KEYS = {"name", "measure", "op", "bound", "words"}
_OTHER_KEYS = {"role", "exact", "plain", "cause", "shown_by"}


@dataclass(frozen=True)
class ReadCondition:
    """A condition with its role in the reading.

    Parameters
    ----------
    role : str
        One of `ROLES`.
    condition : Condition
        Its ``part`` does not count.
    exact : bool
        Whether the number has no error of sampling, so that its value alone answers.
    """

    role: str
    condition: Condition
    exact: bool = False

    def __post_init__(self) -> None:
        if self.role not in ROLES:
            raise InputError(
                f"condition '{self.condition.name}': role must be one of {', '.join(ROLES)}, got '{self.role}'"
            )

    def answer(self, measured: Measured) -> str:
        """One of `ANSWERS`."""
        number = measured.get(self.condition.measure, {})
        asked = number.get("ci95") or ([number.get("value")] if self.exact else None)
        finite = [x for x in asked or () if x is not None and math.isfinite(x)]
        if not finite or len(finite) < len(asked or ()):
            return MISSING
        low, high = finite[0], finite[-1]
        bound, op = self.condition.bound, OPS[self.condition.op]
        if op(low, bound) and op(high, bound):
            return YES
        if isinstance(bound, tuple):
            return NO if high < bound[0] or low > bound[1] else OPEN
        return OPEN if op(low, bound) or op(high, bound) else NO


@dataclass(frozen=True)
class SecondReading:
    """The conditions of a second reading, and why there is one.

    Parameters
    ----------
    why : str
        How it differs from the first reading.
    conditions : tuple of ReadCondition
        One or more of them headlines.
    minority : float
        Share of the grid above which a headline that fails at the default still holds in part, in (0, 1).
    """

    why: str
    conditions: tuple[ReadCondition, ...]
    minority: float = MINORITY

    def __post_init__(self) -> None:
        names = [one.condition.name for one in self.conditions]
        roles = [one.role for one in self.conditions]
        if len(set(names)) < len(names) or HEADLINE not in roles:
            raise InputError(
                "a second reading must have conditions of different names, with a headline among them, "
                f"got {', '.join(f'{name} ({role})' for name, role in zip(names, roles, strict=True))}"
            )
        if not 0 < self.minority < 1:
            raise InputError(f"minority must lie between 0 and 1, got {self.minority}")

    @classmethod
    def from_data(cls, data: Mapping[str, Any], first: Predicate) -> "SecondReading":
        """From ``[second]`` of a ``claim.toml``; ``first = "name"`` takes a condition of the first reading."""
        filed = {condition.name: condition for condition in first.conditions}
        conditions = tuple(_condition(one, filed) for one in data["conditions"])
        return cls(data["why"], conditions, data.get("minority", MINORITY))

    def to_data(self) -> dict[str, Any]:
        """As plain data, in which it is filed."""
        conditions = [
            {"role": one.role, "exact": one.exact, "name": c.name, "measure": c.measure, "op": c.op,
             "bound": list(c.bound) if isinstance(c.bound, tuple) else c.bound, "words": c.words}
            for one in self.conditions for c in [one.condition]
        ]  # fmt: skip
        return {"why": self.why, "minority": self.minority, "conditions": conditions}

    @property
    def measures(self) -> set[str]:
        """Names of the measures that it reads."""
        return {one.condition.measure for one in self.conditions}

    def answers(self, measured: Measured, role: str) -> list[str]:
        """The answers of the conditions of a role."""
        return [one.answer(measured) for one in self.conditions if one.role == role]

    def verdict(self, measured: Measured) -> str:
        """One of `SECOND_VERDICTS`."""
        headline, printed, grid = (self.answers(measured, role) for role in (HEADLINE, PRINTED, GRID))
        if MISSING in (*headline, *printed, *grid):
            return UNTESTED
        if NO in headline:
            return IN_PART if self._in_a_minority(measured) else FAILS
        if OPEN in headline:
            return UNDECIDED
        if NO in (*printed, *grid):
            return IN_PART
        return UNDECIDED if OPEN in (*printed, *grid) else HOLDS

    def _in_a_minority(self, measured: Measured) -> bool:
        grid = [one for one in self.conditions if one.role == GRID]
        shares = [measured[one.condition.measure] for one in grid]
        return bool(shares) and all((share.get("ci95") or [share["value"]])[0] > self.minority for share in shares)

    def said(self, measured: Measured) -> str:
        """Each condition that counts with its answer and number, in words."""
        counted = [one for one in self.conditions if one.role in (HEADLINE, PRINTED, GRID)]
        return "; ".join(f"{one.answer(measured)}: {_in_words(one.condition, measured)}" for one in counted) + "."


def _in_words(condition: Condition, measured: Measured) -> str:
    number = measured.get(condition.measure)
    return f"{condition.words} ({number_in_words(number) if number else 'not measured'})"


def _condition(data: Mapping[str, Any], filed: Mapping[str, Condition]) -> ReadCondition:
    role, exact = data.get("role", ""), data.get("exact", False)
    if "first" in data:
        if data["first"] not in filed:
            raise InputError(
                f"second reading: first must name a condition of the first reading, got '{data['first']}'"
            )
        return ReadCondition(role, filed[data["first"]], exact)
    given: Sequence[str] = sorted(data.keys() - _OTHER_KEYS)
    if set(given) != _KEYS:
        raise InputError(
            f"second reading: a condition must have {', '.join(sorted(_KEYS))}, got {', '.join(given)}"
        )
    bound = tuple(data["bound"]) if isinstance(data["bound"], list) else data["bound"]
    condition = Condition(data["name"], data["measure"], "interval", data["op"], bound, data["words"])
    return ReadCondition(role, condition, exact)
