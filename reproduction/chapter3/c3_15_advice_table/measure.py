"""Measures and rows of claim C3.15."""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.domains.advice.explorers import EXPLORERS
from reproduction.chapter3.advice.buildings import name_of, other_choices
from reproduction.chapter3.advice.mazes import AGENTS, grid_of, grid_share, maze_estimate
from reproduction.chapter3.c3_15_advice_table.run import (
    BETTER,
    GOAL_UNKNOWN,
    LEARNER,
    NONE,
    THESIS,
    UNIFORM_ONLY,
)
from reproduction.engine.estimates import exact_value, is_above
from reproduction.engine.results_table import ResultsTable


class Rewards:
    """Rewards of agents and of Q-learning in one cell of the grid, maze by maze, of 1000."""

    def __init__(self, results: Sequence[Mapping], loops: float, experts: str) -> None:
        self.walks = ResultsTable.nested(results, "walks", ("experts", "way", "agent"), ("loops",))
        self.learners = ResultsTable.nested(results, "learners", ("experts",), ("loops",))
        self.loops, self.experts = loops, experts

    def numbers(self, name: str, way: str, agent: str) -> np.ndarray:
        """(n_mazes, n_tasks); without advice there are no experts."""
        experts = None if way == NONE else self.experts
        return self.walks.values(name, loops=self.loops, experts=experts, way=way, agent=agent)

    def of(self, way: str, agent: str) -> np.ndarray:
        """Mean reward in each maze."""
        return 1000 * self.numbers("reached", way, agent).mean(axis=1)

    def gain(self, way: str, agent: str) -> Estimate:
        """Reward that an advisor adds."""
        return maze_estimate(self.of(way, agent) - self.of(NONE, agent))

    def advised(self, way: str, agent: str) -> np.ndarray:
        """Advised steps in 100 of each walk, (n_mazes, n_tasks)."""
        return 100 * self.numbers("advised", way, agent) / self.numbers("steps", way, agent)

    def least(self, way: str) -> Estimate:
        """The least mean reward of the explorers."""
        return exact_value(min(self.of(way, agent).mean() for agent in EXPLORERS), len(EXPLORERS))

    def raised(self) -> int:
        """Explorers whose reward the thesis's advisor raises for certain."""
        return sum(is_above(self.gain(THESIS, agent), 0.0) for agent in EXPLORERS)

    def learning(self, way: str) -> np.ndarray:
        """Q-learning's final reward in each maze, with the thesis's advice or without."""
        experts = None if way == NONE else self.experts
        return self.learners.values("final", loops=self.loops, experts=experts).mean(axis=1)

    def learning_gain(self) -> Estimate:
        """Final reward that advice adds to Q-learning."""
        return maze_estimate(self.learning(THESIS) - self.learning(NONE))


class BuildingRewards:
    """Rewards by building, α⁰ of the advice (None: without advice) and agent, maze by maze, of 1000."""

    def __init__(self, results: Sequence[Mapping]) -> None:
        self.table = ResultsTable.nested(results, "rewards", ("alpha0", "agent"), ("building", "maze"))
        self.results = results

    def of(self, building: int, alpha0: float | None, agent: str) -> np.ndarray:
        return self.table.values("reward", building=building, alpha0=alpha0, agent=agent)

    def gain(self, building: int, alpha0: float, agent: str) -> Estimate:
        """Reward that advice adds."""
        return maze_estimate(self.of(building, alpha0, agent) - self.of(building, None, agent))

    def raised(self, building: int, alpha0: float) -> int:
        """Explorers whose reward the advice raises for certain."""
        return sum(is_above(self.gain(building, alpha0, agent), 0.0) for agent in EXPLORERS)

    def walls(self, building: int) -> list[float]:
        """Share of wall cells in each maze."""
        return [result["walls"] for result in self.results if result["building"] == building]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Rewards at the default by agent and advisor, Q-learning's, the share of the grid, and of other buildings."""
    results, beside = _read_first(results)
    at_default = Rewards(results, **settings["default"])
    found = {
        "explorers_raised": exact_value(at_default.raised(), len(EXPLORERS)),
        "optimal_thesis": maze_estimate(at_default.of(THESIS, "optimal")),
        "q_learning_thesis": maze_estimate(at_default.learning(THESIS)),
        "q_learning_gain": at_default.learning_gain(),
    }
    for way in (THESIS, BETTER, UNIFORM_ONLY, GOAL_UNKNOWN):
        found[f"{way.replace(' ', '_')}_least"] = at_default.least(way)
    for agent in AGENTS:  # the rows leave this advisor out
        found[f"{agent}_goal_unknown"] = maze_estimate(at_default.of(GOAL_UNKNOWN, agent))
    most = [at_default.advised(BETTER, agent) for agent in EXPLORERS]
    found["better_most_advised"] = exact_value(np.max(most), len(most[0]))
    grid, buildings = [Rewards(results, *cell) for cell in grid_of(settings)], BuildingRewards(beside)
    found["grid_all_raised"] = grid_share([cell.raised() == len(EXPLORERS) for cell in grid])
    return found | _of_buildings(settings, buildings) | _crossed(settings, grid, buildings)


def _read_first(results: Sequence[Mapping]) -> tuple[list[Mapping], list[Mapping]]:
    """Results of the grid that the first reading reads, and those of buildings beside it."""
    return [r for r in results if "walks" in r], [r for r in results if "rewards" in r]


def _of_buildings(settings: Mapping, beside: BuildingRewards) -> dict[str, Estimate]:
    """Table 3.1 where all agents start alike, and what random motion receives in the other buildings."""
    found = {f"one_start_{agent}_gain": beside.gain(0, 0.0, agent) for agent in (*EXPLORERS, LEARNER)}
    for agent in (*AGENTS, LEARNER):
        for way, alpha0 in ((NONE, None), (THESIS, 0.0)):
            found[f"one_start_{agent}_{way}"] = maze_estimate(beside.of(0, alpha0, agent))
    for place, building in enumerate(settings["buildings"]):
        found[f"{name_of(building)}_walls"] = maze_estimate(beside.walls(place))
        found[f"{name_of(building)}_random_none"] = maze_estimate(beside.of(place, None, "random"))
        found[f"{name_of(building)}_random_gain"] = beside.gain(place, 0.0, "random")
    return found


def _crossed(settings: Mapping, grid: Sequence[Rewards], beside: BuildingRewards) -> dict[str, Estimate]:
    """Shares of the mazes and of the choices beside the default in which advice raises rewards for certain."""
    others = other_choices(settings)
    explorers = [cell.raised() for cell in grid] + [beside.raised(*choice) for choice in others]
    learners = [cell.learning_gain() for cell in grid] + [beside.gain(*choice, LEARNER) for choice in others]
    return {
        "crossed_all_raised": grid_share([number == len(EXPLORERS) for number in explorers]),
        "crossed_learning_raised": grid_share([is_above(gain, 0.0) for gain in learners]),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The whole grid: a row for each cell, advisor and agent, Q-learning last; then the buildings beside it."""
    results, beside = _read_first(results)
    found = []
    for loops, experts in grid_of(settings):
        rewards = Rewards(results, loops, experts)
        for way, agent in product((NONE, THESIS, BETTER, UNIFORM_ONLY), AGENTS):
            gain = None if way == NONE else rewards.gain(way, agent)
            row = {"loops": loops, "experts": experts, "way": way, "agent": agent}
            row |= _numbers(maze_estimate(rewards.of(way, agent)), gain)
            row["advised"] = round(float(rewards.advised(way, agent).mean(axis=1).mean()), 1)
            row["median_steps"] = float(np.median(rewards.numbers("steps", way, agent)))
            found.append(row)
        for way in (NONE, THESIS):
            gain = None if way == NONE else rewards.learning_gain()
            row = {"loops": loops, "experts": experts, "way": way, "agent": "q-learning"}
            found.append(row | _numbers(maze_estimate(rewards.learning(way)), gain))
    return found + _building_rows(settings, beside)


def _building_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row for each building, α⁰ of the advice (None: without advice) and agent."""
    rewards, found = BuildingRewards(results), []
    alone = [(place, None) for place in range(len(settings["buildings"]))]
    for place, alpha0 in [*alone, (0, 0.0), *other_choices(settings)]:
        for agent in (*AGENTS, LEARNER):
            gain = None if alpha0 is None else rewards.gain(place, alpha0, agent)
            row = {"building": settings["buildings"][place], "alpha0": alpha0, "walker": agent}
            found.append(row | _numbers(maze_estimate(rewards.of(place, alpha0, agent)), gain))
    return found


def _numbers(reward: Estimate, gain: Estimate | None) -> dict[str, Any]:
    ends = [round(end, 1) for end in reward.ci95] if reward.ci95 else None
    row: dict[str, Any] = {"reward": round(reward.value, 1), "ci95": ends}
    if gain is not None:
        certain = bool(gain.ci95 and gain.ci95[0] * gain.ci95[1] > 0)
        row |= {"gain": round(gain.value, 1), "gain_is_certain": certain}
    return row
