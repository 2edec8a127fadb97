"""Interleaved rounds: everyone is measured in every round, so that a busy machine is busy for all alike."""

import math
from collections.abc import Callable, Mapping, Sequence
from statistics import median
from typing import Any

from lifelore.core.metrics import Estimate

Rates = dict[str, list[float]]


def interleaved(
    contenders: Mapping[str, Callable[[], float]], repeats: int, after: Callable[[str], None]
) -> Rates:
    """Each contender's measurements, one a round; every second round runs in the opposite order."""
    rates: Rates = {name: [] for name in contenders}
    for number in range(repeats):
        for name in list(contenders)[:: -1 if number % 2 else 1]:
            rates[name].append(contenders[name]())
            after(name)
    return rates


def paired_ratio(top: Sequence[float], bottom: Sequence[float]) -> float:
    """Median of the ratios of measurements made in the same round."""
    return median(a / b for a, b in zip(top, bottom, strict=True))


def row(name: str, value: float | None, unit: str, ratio_to: str | None = None, ratio=None) -> dict[str, Any]:
    """One line of the table; `ratio` is this row's value over that of the row `ratio_to`."""
    return {"name": name, "value": value, "unit": unit, "ratio_to": ratio_to, "ratio": ratio}


def estimated_row(
    name: str, estimate: Estimate, unit: str, ratio_to: str | None = None, ratio: Estimate | None = None
) -> dict[str, Any]:
    """One line of the table from an estimate, with its interval and the number of values behind it.

    Where there was nothing to measure (the value is not finite), value and interval are None. `ratio` is this
    row's value over that of the row `ratio_to`; its interval is ``ratio_ci95``. Without a ratio, `ratio_to`
    does not count.
    """
    if not math.isfinite(estimate.value):
        return row(name, None, unit) | {"ci95": None, "n": estimate.n}
    line = row(name, estimate.value, unit) | {"ci95": estimate.to_dict()["ci95"], "n": estimate.n}
    if ratio is None:
        return line
    return line | {"ratio_to": ratio_to, "ratio": ratio.value, "ratio_ci95": ratio.to_dict()["ci95"]}


def at_least(name: str, goal: float, measured: float | None) -> dict[str, Any]:
    """A goal met by `goal` or more; not decided where nothing was measured."""
    met = None if measured is None else measured >= goal
    return {"name": name, "goal": f">= {goal}", "measured": measured, "met": met}


def at_most(name: str, goal: float, measured: float | None) -> dict[str, Any]:
    """A goal met by `goal` or less; not decided where nothing was measured."""
    met = None if measured is None else measured <= goal
    return {"name": name, "goal": f"<= {goal}", "measured": measured, "met": met}
