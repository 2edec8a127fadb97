"""Measures and rows of claim C3.18."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.domains.advice.explorers import EXPLORERS
from lifelore.experiments.chapter3.advice_estimates import (
    at,
    grid_of,
    is_positive,
    maze_estimate,
    picked,
    plain,
    share_of_grid,
)
from lifelore.experiments.engine.estimates import UNMEASURED

READINGS = ("told", "own", "unadvised")
"""All steps in H; only the agent's own; all in H, read where no advice was given."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """At the default: P(M₁ | H) of each explorer alone and told, by every reading; how many rise; the grid."""
    default = settings["default"]
    cells, experts = at(results, default["loops"]), default["experts"]
    found = {}
    for agent in EXPLORERS:
        entries = _entries(cells, experts, agent)
        for reading in ("alone", *READINGS):
            found[f"normal_{reading}_{agent}"] = _mean(entries, reading)
        for reading in READINGS:
            found[f"gain_{reading}_{agent}"] = _gain(entries, reading)
        found[f"advised_{agent}"] = maze_estimate([100 * np.mean(e["advised_share"]) for e in entries])
    for reading, name in zip(READINGS, ("", "_own", "_unadvised"), strict=True):
        found[f"explorers_raised{name}"] = plain(_raised(cells, experts, reading), len(EXPLORERS))
    for reading, name in zip(READINGS, ("", "_own", "_unadvised"), strict=True):
        answers = [_raised(at(results, loops), e, reading) == len(EXPLORERS) for loops, e in grid_of(settings)]
        found[f"grid_all_raised{name}"] = share_of_grid(answers)
    return found


def _entries(cells: Sequence[Mapping], experts: str, agent: str) -> list[Mapping]:
    return [picked(cell["explorers"], experts=experts, agent=agent) for cell in cells]


def _mean(entries: Sequence[Mapping], reading: str) -> Estimate:
    kept = [[p for p in entry[reading] if p is not None] for entry in entries]
    means = [np.mean(of) for of in kept if of]
    return maze_estimate(means) if means else UNMEASURED


def _gain(entries: Sequence[Mapping], reading: str) -> Estimate:
    """What advice adds to an errand's mean P(M₁ | H), over mazes; errands advised throughout left out."""
    gains = [
        [told - alone for told, alone in zip(entry[reading], entry["alone"], strict=True) if told is not None]
        for entry in entries
    ]
    means = [np.mean(of) for of in gains if of]
    return maze_estimate(means) if means else UNMEASURED


def _raised(cells: Sequence[Mapping], experts: str, reading: str) -> int:
    return sum(is_positive(_gain(_entries(cells, experts, agent), reading)) for agent in EXPLORERS)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, a row an explorer; then the default's curves by blocks of steps."""
    found = []
    for loops, experts in grid_of(settings):
        for agent in EXPLORERS:
            entries = _entries(at(results, loops), experts, agent)
            row: dict = {"loops": loops, "experts": experts, "agent": agent}
            row |= {reading: _short(_mean(entries, reading)) for reading in ("alone", *READINGS)}
            gains = {reading: _gain(entries, reading) for reading in READINGS}
            row["certain"] = {reading: bool(g.ci95 and g.ci95[0] * g.ci95[1] > 0) for reading, g in gains.items()}
            row["gain"] = {reading: _short(g) for reading, g in gains.items()}
            found.append(row)
    return found + _curves(settings, results)


def _short(number: Estimate) -> float | None:
    return round(number.value, 4) if np.isfinite(number.value) else None


def _curves(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean P(M₁ | H) over those still walking, and mean reward so far, by block; explorers told and alone."""
    default = settings["default"]
    found = []
    for agent in EXPLORERS:
        entries = _entries(at(results, default["loops"]), default["experts"], agent)
        for way in ("alone", "told"):
            curves = [entry[f"curve_{way}"] for entry in entries]
            p, n, reached = (np.sum([c[key] for c in curves], axis=0) for key in ("p", "n", "reached"))
            mean = [round(float(a / b), 4) if b else None for a, b in zip(p, n, strict=True)]
            reward = np.round(1000 * reached / (len(entries) * settings["tasks"]), 1).tolist()
            found.append({"curve_of": agent, "way": way, "normal": mean, "reward": reward})
    return found
