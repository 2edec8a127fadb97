"""Interleaved rounds: all contenders are measured in every round, so that a busy machine is busy for all alike."""

from collections.abc import Callable, Mapping, Sequence
from statistics import median
from typing import Any

from lifelore.core.protocols import Progress

Rates = dict[str, list[float]]
Part = tuple[list[dict[str, Any]], list[dict[str, Any]]]
"""Rows and goals of a part of a benchmark."""


def joined(*parts: Part) -> dict[str, list[dict[str, Any]]]:
    """Rows and goals of all parts."""
    return {name: [line for part in parts for line in part[i]] for i, name in enumerate(("rows", "goals"))}


def counted(progress: Progress, total: int) -> Callable[[str], None]:
    """A function of a label that reports one more of `total` pieces as done."""
    done = 0

    def after(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, total, label)

    return after


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


def row_beside(name: str, rates: Rates, unit: str, beside: str | None = None) -> dict[str, Any]:
    """One line of the table from what `interleaved` measured; the ratio is that of paired rounds."""
    ratio = None if beside is None else paired_ratio(rates[name], rates[beside])
    return row(name, median(rates[name]), unit, beside, ratio)


def at_least(name: str, goal: float, measured: float | None) -> dict[str, Any]:
    """A goal met by `goal` or more; not decided where nothing was measured."""
    met = None if measured is None else measured >= goal
    return {"name": name, "goal": f">= {goal}", "measured": measured, "met": met}


def at_most(name: str, goal: float, measured: float | None) -> dict[str, Any]:
    """A goal met by `goal` or less; not decided where nothing was measured."""
    met = None if measured is None else measured <= goal
    return {"name": name, "goal": f"<= {goal}", "measured": measured, "met": met}
