"""A verdict as data: named conditions on measured numbers, and rules that turn them into one of four words.

The conditions of a claim stand in its ``claim.toml``; a test compares them with those filed before the first full
run. A condition is

    {"name": …, "measure": …, "part": "value" | "interval", "op": …, "bound": …, "words": …, "cause": …}

``interval`` asks it of both ends of the 95 % interval; ``cause`` is the likely cause where it is not met, and
``shown_by`` the erratum whose tests show this cause.
A rule is ``{"verdict": …, "all": […]}`` or ``{"verdict": …, "any": […]}``; the first rule met decides, *does not
hold* if none is, *cannot be tested* if a number is missing.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from lifelore.core.errors import InputError

HOLDS, IN_PART, FAILS, UNTESTED = "holds", "holds in part", "does not hold", "cannot be tested"
VERDICTS = (HOLDS, IN_PART, FAILS, UNTESTED)
OPS = {
    ">": lambda x, bound: x > bound,
    ">=": lambda x, bound: x >= bound,
    "<": lambda x, bound: x < bound,
    "<=": lambda x, bound: x <= bound,
    "between": lambda x, bound: bound[0] <= x <= bound[1],
}

Measured = Mapping[str, Mapping]
"""Plain numbers by name, each {"value", "median", "ci95", "n"}."""


@dataclass(frozen=True)
class Condition:
    """One question asked of one measured number; `words` says it in a sentence that can be true or false."""

    name: str
    measure: str
    part: str
    op: str
    bound: float | tuple[float, float]
    words: str

    def __post_init__(self) -> None:
        if self.op not in OPS or self.part not in ("value", "interval"):
            raise InputError(
                f"condition '{self.name}': op must be one of {', '.join(OPS)} and part value or interval, "
                f"got '{self.op}' and '{self.part}'"
            )

    def met(self, measured: Measured) -> bool | None:
        """Whether it is true; None where its number, or the interval asked for, is missing."""
        number = measured.get(self.measure, {})
        asked = number.get("ci95") if self.part == "interval" else [number.get("value")]
        if not asked or any(x is None or not math.isfinite(x) for x in asked):
            return None
        return all(OPS[self.op](x, self.bound) for x in asked)


@dataclass(frozen=True)
class Rule:
    """A verdict and the conditions that bring it: all of `all_of`, and one of `any_of` where it names some."""

    verdict: str
    all_of: tuple[str, ...] = ()
    any_of: tuple[str, ...] = ()

    def met(self, answers: Mapping[str, bool | None]) -> bool:
        some = not self.any_of or any(answers[name] for name in self.any_of)
        return some and all(answers[name] for name in self.all_of)


@dataclass(frozen=True)
class Predicate:
    """Conditions and the rules over them, in order."""

    conditions: tuple[Condition, ...]
    rules: tuple[Rule, ...]

    def __post_init__(self) -> None:
        known = [c.name for c in self.conditions]
        if len(set(known)) != len(known):
            raise InputError(f"conditions must have different names, got {', '.join(known)}")
        for rule in self.rules:
            unknown = {*rule.all_of, *rule.any_of} - set(known)
            if rule.verdict not in VERDICTS or unknown or not (rule.all_of or rule.any_of):
                raise InputError(f"rule must name a verdict and conditions that exist, got {rule}")

    @classmethod
    def from_data(cls, data: Mapping) -> "Predicate":
        """From the conditions and rules of a ``claim.toml``."""
        conditions = tuple(
            Condition(
                c["name"], c["measure"], c["part"], c["op"],
                tuple(c["bound"]) if isinstance(c["bound"], list) else c["bound"], c["words"],
            )
            for c in data["conditions"]
        )  # fmt: skip
        rules = tuple(Rule(r["verdict"], tuple(r.get("all", ())), tuple(r.get("any", ()))) for r in data["rules"])
        return cls(conditions, rules)

    def answers(self, measured: Measured) -> dict[str, bool | None]:
        """Each condition's answer by name; None where it cannot be told."""
        return {c.name: c.met(measured) for c in self.conditions}

    def verdict(self, measured: Measured) -> str:
        """One of `VERDICTS`."""
        answers = self.answers(measured)
        if None in answers.values():
            return UNTESTED
        return next((rule.verdict for rule in self.rules if rule.met(answers)), FAILS)

    def why(self, measured: Measured, causes: Mapping[str, str] | None = None) -> str:
        """What was met and what was not, each with its number, and the likely cause where one is known."""
        kinds = {True: "Met", False: "Not met", None: "Cannot be told"}
        parts = []
        for answer, kind in kinds.items():
            said = [
                _said(c, measured, (causes or {}).get(c.name, "") if answer is False else "")
                for c in self.conditions
                if c.met(measured) is answer
            ]
            if said:
                parts.append(f"{kind}: {'; '.join(said)}.")
        return " ".join(parts)


def _said(condition: Condition, measured: Measured, cause: str) -> str:
    number = measured.get(condition.measure)
    shown = number_in_words(number) if number else "not measured"
    return f"{condition.words} ({shown})" + (f", likely because {cause}" if cause else "")


def number_in_words(number: Mapping, significant: int = 3) -> str:
    """An estimate as people read it: ``1.23 [1.10, 1.31], n 50``."""
    if number["value"] is None:
        return f"no finite value, n {number['n']}"
    interval = ""
    if number["ci95"]:
        interval = f" [{short(number['ci95'][0], significant)}, {short(number['ci95'][1], significant)}]"
    return f"{short(number['value'], significant)}{interval}, n {number['n']}"


def short(x: float, significant: int = 3) -> str:
    """A number to so many significant digits, without an exponent from 0.001 to a million."""
    if x == 0 or not math.isfinite(x):
        return "0" if x == 0 else str(x)
    digits = max(0, significant - 1 - math.floor(math.log10(abs(x))))
    text = f"{x:,.{digits}f}" if digits <= significant + 2 else f"{x:.{significant - 1}e}"
    return (text.rstrip("0").rstrip(".") if "." in text and "e" not in text else text).replace("-", "−")
