"""Measures and rows of claim C3.18."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.domains.advice.explorers import EXPLORERS
from reproduction.chapter3.advice.mazes import grid_of, grid_share, maze_estimate
from reproduction.engine.estimates import UNMEASURED, exact_value, is_above
from reproduction.engine.results_table import ResultsTable

READINGS = {"told": "", "own": "_own", "unadvised": "_unadvised"}
"""All steps in H; only the agent's own; all in H, at the steps without advice. And the endings of measures."""


def _table(results: Sequence[Mapping]) -> ResultsTable:
    return ResultsTable.nested(results, "explorers", ("experts", "agent"), ("loops",))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Each explorer's gain in P(M₁ | H) at the default; by reading, how many are raised, and the grid."""
    table, default = _table(results), settings["default"]
    found = {f"gain_{agent}": _gain(table.select(**default, agent=agent), "told") for agent in EXPLORERS}
    for reading, ending in READINGS.items():
        raised = [_raised(table, reading, *cell) for cell in grid_of(settings)]
        at_default = _raised(table, reading, **default)
        found[f"explorers_raised{ending}"] = exact_value(at_default, len(EXPLORERS))
        found[f"grid_all_raised{ending}"] = grid_share([number == len(EXPLORERS) for number in raised])
    return found


def _raised(table: ResultsTable, reading: str, loops: float, experts: str) -> int:
    """Explorers whose P(M₁ | H) rises for certain."""
    gains = [_gain(table.select(loops=loops, experts=experts, agent=agent), reading) for agent in EXPLORERS]
    return sum(is_above(gain, 0.0) for gain in gains)


def _mean(table: ResultsTable, reading: str) -> Estimate:
    return _over_mazes(table.values(reading))


def _gain(table: ResultsTable, reading: str) -> Estimate:
    """What advice adds to an errand's mean P(M₁ | H)."""
    return _over_mazes(table.values(reading) - table.values("alone"))


def _over_mazes(values: np.ndarray) -> Estimate:
    """The mean over mazes of (n_mazes, n_tasks); errands that were advised throughout are NaN and left out."""
    measured = [of_maze[np.isfinite(of_maze)] for of_maze in values]
    means = [of_maze.mean() for of_maze in measured if of_maze.size]
    return maze_estimate(means) if means else UNMEASURED


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, a row an explorer; then the default's curves by blocks of steps."""
    table, found = _table(results), []
    for loops, experts in grid_of(settings):
        for agent in EXPLORERS:
            walks = table.select(loops=loops, experts=experts, agent=agent)
            gains = {reading: _gain(walks, reading) for reading in READINGS}
            row: dict = {"loops": loops, "experts": experts, "agent": agent}
            row |= {reading: _short(_mean(walks, reading)) for reading in ("alone", *READINGS)}
            row["certain"] = {reading: bool(g.ci95 and g.ci95[0] * g.ci95[1] > 0) for reading, g in gains.items()}
            row["gain"] = {reading: _short(g) for reading, g in gains.items()}
            found.append(row)
    for agent in EXPLORERS:
        walks = table.select(**settings["default"], agent=agent).records
        for way in ("alone", "told"):
            curves = [walk[f"curve_{way}"] for walk in walks]
            p, n, reached = (np.sum([curve[key] for curve in curves], axis=0) for key in ("p", "n", "reached"))
            mean = [round(float(a / b), 4) if b else None for a, b in zip(p, n, strict=True)]
            reward = np.round(1000 * reached / (len(walks) * settings["tasks"]), 1).tolist()
            found.append({"curve_of": agent, "way": way, "normal": mean, "reward": reward})
    return found


def _short(number: Estimate) -> float | None:
    return round(number.value, 4) if np.isfinite(number.value) else None
