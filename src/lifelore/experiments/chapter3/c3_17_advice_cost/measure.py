"""Measures and rows of claim C3.17."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter3.advice_estimates import (
    at,
    grid_of,
    is_positive,
    maze_estimate,
    picked,
    plain,
    share_of_grid,
)
from lifelore.experiments.chapter3.advice_grid import AGENTS

RISE = 5.0
"""Advised steps in 100; a mean that rises by no more does not count as rising."""


def agents_of(settings: Mapping) -> list[str]:
    """The agents of fixed policy, and Q-learning after each number of episodes."""
    return [*AGENTS, *(f"q {episodes}" for episodes in settings["snapshots"])]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """At the default: advice by agent at κ and at 0, how it falls, Q-learning's two ends, and the ceiling."""
    default = settings["default"]
    cells, how = at(results, default["loops"]), {"experts": default["experts"], "heeds": default["heeds"]}
    at_kappa = settings["kappas"].index(settings["kappa"])
    amounts = {agent: _per_100(cells, how, agent) for agent in agents_of(settings)}
    found = {f"advised_{agent.replace(' ', '_')}": maze_estimate(a[:, at_kappa]) for agent, a in amounts.items()}
    found["advice_at_zero"] = plain(_least_at_zero(settings, cells, how), len(amounts))
    found["advice_at_zero_all_steps"] = maze_estimate(np.mean([a[:, 0] for a in amounts.values()], axis=0))
    found["agents_falling"] = share_of_grid([_falls(a) for a in amounts.values()])
    found["largest_rise"] = plain(max(_rise(a) for a in amounts.values()), len(amounts))
    first, last = (amounts[f"q {settings['snapshots'][i]}"][:, at_kappa] for i in (0, -1))
    found["early_minus_random"] = maze_estimate(first - amounts["random"][:, at_kappa])
    found["late_minus_optimal"] = maze_estimate(last - amounts["optimal"][:, at_kappa])
    ceilings = [picked(cell["ceilings"], experts=default["experts"]) for cell in cells]
    found["ceiling_reaches_kappa"] = maze_estimate([c["states"][at_kappa] for c in ceilings])
    every = [c["above"] for cell in results for c in cell["ceilings"]]
    found["gains_above_ceiling"] = plain(sum(every), len(every))
    found["grid_falling"] = share_of_grid(_grid_answers(settings, results))
    return found


def _per_100(cells: Sequence[Mapping], how: Mapping, agent: str, of: str = "steps") -> np.ndarray:
    """Advised steps in 100, of all or of those where an expert passed, (mazes, kappas)."""
    entries = [picked(cell["amounts"], **how, agent=agent) for cell in cells]
    return np.array([100 * np.array(e["advised"]) / np.maximum(e[of], 1) for e in entries])


def _least_at_zero(settings: Mapping, cells: Sequence[Mapping], how: Mapping) -> float:
    return min(_per_100(cells, how, agent, "known")[:, 0].mean() for agent in agents_of(settings))


def _falls(amounts: np.ndarray) -> bool:
    """Whether advice at the greatest κ is less than at 0 for certain."""
    return is_positive(maze_estimate(amounts[:, 0] - amounts[:, -1]))


def _rise(amounts: np.ndarray) -> float:
    """The most by which the mean rises from any κ to a greater one; 0 where it never does."""
    mean = amounts.mean(axis=0)
    return float((mean - np.minimum.accumulate(mean)).max())


def _grid_answers(settings: Mapping, results: Sequence[Mapping]) -> list[bool]:
    answers = []
    for heeds in (True, False):
        for loops, experts in grid_of(settings):
            how = {"experts": experts, "heeds": heeds}
            amounts = [_per_100(at(results, loops), how, agent) for agent in agents_of(settings)]
            answers.append(all(_falls(a) and _rise(a) <= RISE for a in amounts))
    return answers


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Advice by κ for every agent and cell of the grid, with its deviation over mazes; and the ceilings."""
    found = []
    for loops, experts in grid_of(settings):
        cells = at(results, loops)
        for heeds in (True, False):
            for agent in agents_of(settings):
                amounts = _per_100(cells, {"experts": experts, "heeds": heeds}, agent)
                spread = amounts.std(axis=0, ddof=1) if len(amounts) > 1 else np.zeros(amounts.shape[1])
                row = {"loops": loops, "experts": experts, "heeds": heeds, "agent": agent}
                mean, deviation = (np.round(of, 1).tolist() for of in (amounts.mean(axis=0), spread))
                found.append({**row, "mean": mean, "deviation": deviation})
        states = np.mean([picked(cell["ceilings"], experts=experts)["states"] for cell in cells], axis=0)
        found.append({"loops": loops, "experts": experts, "ceiling": np.round(states, 3).tolist()})
    return found
