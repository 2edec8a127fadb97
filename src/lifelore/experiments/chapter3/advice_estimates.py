"""Numbers over mazes: means by maze, gains, and whether they are certain; and what settings must obey."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.advice.advice_maze import MAX_SIZE
from lifelore.experiments.chapter3.advice_grid import EXPERTS

ROUNDING = 12
"""Decimals of a maze's number."""


def maze_estimate(values: ArrayLike) -> Estimate:
    """Mean over mazes; of three or more that all agree the interval is the value itself."""
    # A difference that is nothing but rounding must not pass for a certain gain.
    values = np.round(np.asarray(values, float), ROUNDING)
    found = mean_estimate(values)
    if found.ci95 is None and len(values) >= 3:
        found = replace(found, ci95=(found.value, found.value))
    return found


def is_positive(found: Estimate) -> bool:
    """Whether the interval lies above 0."""
    return found.ci95 is not None and found.ci95[0] > 0


def plain(value: float, n: int) -> Estimate:
    """A count, a share of a grid or the least of several means: no interval of its own."""
    return Estimate(float(value), float(value), None, n)


def share_of_grid(answers: Sequence[bool]) -> Estimate:
    """Share of the grid's cells where it is so."""
    return plain(float(np.mean(answers)), len(answers))


def at(results: Sequence[Mapping], loops: float) -> list[Mapping]:
    """The cells of one loop density, by maze."""
    return [result for result in results if result["loops"] == loops]


def picked(entries: Sequence[Mapping], **wanted) -> Mapping:
    """The one entry of a cell that has these keys."""
    return next(entry for entry in entries if all(entry[key] == value for key, value in wanted.items()))


def grid_of(settings: Mapping) -> list[tuple[float, str]]:
    """Loop densities crossed with kinds of experts."""
    return [(loops, experts) for loops in settings["loops"] for experts in settings["experts"]]


def check_grid(settings: Mapping, counts: Sequence[str]) -> None:
    """Raise `InputError` for settings that cannot be run; `counts` must each be at least 1."""
    for key in (*counts, "mazes", "expert_walks", "few_walks", "window"):
        if settings[key] < 1:
            raise InputError(f"{key} must be at least 1, got {settings[key]}")
    if not 13 <= settings["size"] <= MAX_SIZE:
        raise InputError(
            f"size must lie in [13, {MAX_SIZE}], so that eight goals find room, got {settings['size']}"
        )
    if settings["kappa"] < 0:
        raise InputError(f"kappa must be at least 0, got {settings['kappa']}")
    if not settings["loops"] or not all(0 <= loops <= 1 for loops in settings["loops"]):
        raise InputError(f"loops must be shares in [0, 1], got {settings['loops']}")
    unknown = set(settings["experts"]) - set(EXPERTS)
    if unknown or not settings["experts"]:
        raise InputError(f"experts must be among {', '.join(EXPERTS)}, got {settings['experts']}")
    default = settings["default"]
    if default.get("loops") not in settings["loops"] or default.get("experts") not in settings["experts"]:
        raise InputError(f"default must be a cell of the grid of loops and experts, got {default}")
