"""Measures and rows of claim C3.17."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate
from reproduction.chapter3.advice.mazes import AGENTS, grid_of, grid_share, maze_estimate
from reproduction.engine.estimates import exact_value, is_above
from reproduction.engine.results_table import ResultsTable, curve_of

RISE = 5.0
"""Advised steps in 100; a mean that rises by no more does not count as rising."""


def agents_of(settings: Mapping) -> list[str]:
    """The agents of fixed policy, and Q-learning after each number of episodes."""
    return [*AGENTS, *(f"q {episodes}" for episodes in settings["snapshots"])]


def _tables(results: Sequence[Mapping]) -> tuple[ResultsTable, ResultsTable]:
    """Advised steps by agent, and the ceilings."""
    amounts = ResultsTable.nested(results, "amounts", ("experts", "heeds", "agent"), ("loops",))
    return amounts, ResultsTable.nested(results, "ceilings", ("experts",), ("loops",))


def _per_100(table: ResultsTable, cell: Mapping, agent: str, of: str = "steps") -> np.ndarray:
    """Advised steps in 100, of all or of those where an expert passed, (mazes, kappas)."""
    advised, steps = (table.values(name, agent=agent, **cell) for name in ("advised", of))
    return 100 * advised / np.maximum(steps, 1)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """At the default: advice at 0, how it falls, Q-learning's two ends; the ceiling and the grid."""
    (table, ceilings), default = _tables(results), settings["default"]
    agents, at_kappa = agents_of(settings), settings["kappas"].index(settings["kappa"])
    amounts = {agent: _per_100(table, default, agent) for agent in agents}
    at_zero = min(_per_100(table, default, agent, "known")[:, 0].mean() for agent in agents)
    early, late = (f"q {settings['snapshots'][i]}" for i in (0, -1))
    first, last, random, optimal = (amounts[a][:, at_kappa] for a in (early, late, "random", "optimal"))
    steepest = max((_steepest_rise(amount) for amount in amounts.values()), key=np.mean)
    above = [row["above"] for row in ceilings.records]
    return {
        "advice_at_zero": exact_value(at_zero, len(agents)),
        "agents_falling": grid_share([_falls(amount) for amount in amounts.values()]),
        "largest_rise": exact_value(max(map(_rise, amounts.values())), len(agents)),
        "largest_rise_over_mazes": maze_estimate(steepest),
        "early_minus_random": maze_estimate(first - random),
        "late_minus_optimal": maze_estimate(last - optimal),
        "gains_above_ceiling": exact_value(sum(above), len(above)),
        "grid_falling": grid_share(_grid_answers(settings, table)),
    }


def _falls(amounts: np.ndarray) -> bool:
    """Whether advice at the greatest κ is less than at 0 for certain."""
    return is_above(maze_estimate(amounts[:, 0] - amounts[:, -1]), 0.0)


def _rise(amounts: np.ndarray) -> float:
    """The most by which the mean rises from any κ to a greater one; 0 where it never does."""
    mean = amounts.mean(axis=0)
    return float((mean - np.minimum.accumulate(mean)).max())


def _steepest_rise(amounts: np.ndarray) -> np.ndarray:
    """Each maze's rise between the two κ where the mean rises most, (n_mazes,); 0 where it never does."""
    mean = amounts.mean(axis=0)
    last = int((mean - np.minimum.accumulate(mean)).argmax())
    first = int(mean[: last + 1].argmin())
    return amounts[:, last] - amounts[:, first]


def _grid_answers(settings: Mapping, table: ResultsTable) -> list[bool]:
    answers = []
    for heeds, (loops, experts) in product((True, False), grid_of(settings)):
        cell = {"loops": loops, "experts": experts, "heeds": heeds}
        amounts = [_per_100(table, cell, agent) for agent in agents_of(settings)]
        answers.append(all(_falls(a) and _rise(a) <= RISE for a in amounts))
    return answers


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Advice by κ for every agent and cell of the grid, with its deviation over mazes; and the ceilings."""
    (table, ceilings), found = _tables(results), []
    for loops, experts in grid_of(settings):
        for heeds, agent in product((True, False), agents_of(settings)):
            cell = {"loops": loops, "experts": experts, "heeds": heeds}
            curve = curve_of(_per_100(table, cell, agent), 1, ("mean", "deviation"))
            found.append({**cell, "agent": agent, **curve})
        states = ceilings.values("states", loops=loops, experts=experts).mean(axis=0)
        found.append({"loops": loops, "experts": experts, "ceiling": np.round(states, 3).tolist()})
    return found
