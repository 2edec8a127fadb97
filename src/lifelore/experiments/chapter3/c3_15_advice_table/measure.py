"""Measures and rows of claim C3.15."""

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
from lifelore.experiments.chapter3.advice_grid import AGENTS
from lifelore.experiments.chapter3.advised_explorers import BETTER, GOAL_UNKNOWN, PLAIN, THESIS, UNIFORM_ONLY

WAYS = (PLAIN, THESIS, BETTER, UNIFORM_ONLY)
GOAL = 700


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Rewards at the default by agent and advisor, Q-learning's, and the shares of the grid."""
    default = settings["default"]
    cells, experts = at(results, default["loops"]), default["experts"]
    found = {}
    for agent in AGENTS:
        for way in (*WAYS, GOAL_UNKNOWN):
            found[f"{agent}_{_word(way)}"] = maze_estimate(_rewards(cells, experts, way, agent))
        found[f"gain_{agent}"] = maze_estimate(_gains(cells, experts, agent))
        for way in (THESIS, BETTER, UNIFORM_ONLY):
            found[f"advised_{_word(way)}_{agent}"] = maze_estimate(_advised(cells, experts, way, agent))
    found |= _learning(cells, experts)
    found["explorers_raised"] = plain(_raised(cells, experts), len(EXPLORERS))
    for way in (THESIS, BETTER, UNIFORM_ONLY, GOAL_UNKNOWN):
        found[f"{_word(way)}_least"] = plain(_least(cells, experts, way), len(EXPLORERS))
    found["better_most_advised"] = plain(_most_advised(cells, experts, BETTER), len(cells))
    return found | _grid_shares(settings, results)


def _word(way: str) -> str:
    return way.replace(" ", "_")


def _entries(cells: Sequence[Mapping], experts: str | None, way: str, agent: str) -> list[Mapping]:
    """An agent's walks, maze by maze; without advice there are no experts."""
    experts = None if way == PLAIN else experts
    return [picked(cell["walks"], experts=experts, way=way, agent=agent) for cell in cells]


def _rewards(cells, experts, way: str, agent: str) -> np.ndarray:
    """Mean reward of each maze, of 1000."""
    return np.array([1000 * np.mean(entry["reached"]) for entry in _entries(cells, experts, way, agent)])


def _gains(cells, experts, agent: str) -> np.ndarray:
    return _rewards(cells, experts, THESIS, agent) - _rewards(cells, experts, PLAIN, agent)


def _shares(entry: Mapping) -> np.ndarray:
    """Advised steps in 100 of each walk."""
    return 100 * np.array(entry["advised"]) / np.array(entry["steps"])


def _advised(cells, experts, way: str, agent: str) -> list[float]:
    return [float(_shares(entry).mean()) for entry in _entries(cells, experts, way, agent)]


def _most_advised(cells, experts, way: str) -> float:
    """The greatest share, in 100, of any explorer's walk."""
    return max(_shares(entry).max() for agent in EXPLORERS for entry in _entries(cells, experts, way, agent))


def _least(cells, experts, way: str) -> float:
    return min(_rewards(cells, experts, way, agent).mean() for agent in EXPLORERS)


def _raised(cells, experts) -> int:
    """Explorers whose reward the thesis's advisor raises for certain."""
    return sum(is_positive(maze_estimate(_gains(cells, experts, agent))) for agent in EXPLORERS)


def _finals(cells, experts: str | None) -> np.ndarray:
    return np.array([np.mean(picked(cell["learners"], experts=experts)["final"]) for cell in cells])


def _learning(cells, experts) -> dict[str, Estimate]:
    alone, told = _finals(cells, None), _finals(cells, experts)
    return {
        "q_learning_none": maze_estimate(alone),
        "q_learning_thesis": maze_estimate(told),
        "q_learning_gain": maze_estimate(told - alone),
    }


def _grid_shares(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    grid = [(at(results, loops), experts) for loops, experts in grid_of(settings)]
    return {
        "grid_all_raised": share_of_grid([_raised(*cell) == len(EXPLORERS) for cell in grid]),
        "grid_q_learning_raised": share_of_grid([is_positive(_learning(*c)["q_learning_gain"]) for c in grid]),
        "grid_better_700": share_of_grid([_least(*cell, BETTER) >= GOAL for cell in grid]),
        "grid_uniform_only_700": share_of_grid([_least(*cell, UNIFORM_ONLY) >= GOAL for cell in grid]),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The whole grid: a row for each cell, advisor and agent, Q-learning last."""
    found = []
    for loops, experts in grid_of(settings):
        cells = at(results, loops)
        for way in WAYS:
            found += [_row(cells, loops, experts, way, agent) for agent in AGENTS]
        learning = _learning(cells, experts)
        for way in (PLAIN, THESIS):
            number = learning[f"q_learning_{way}"]
            gain = learning["q_learning_gain"] if way == THESIS else None
            found.append(_plain_row(loops, experts, way, "q-learning", number, gain))
    return found


def _row(cells, loops: float, experts: str, way: str, agent: str) -> dict:
    rewards = _rewards(cells, experts, way, agent)
    gain = None if way == PLAIN else maze_estimate(rewards - _rewards(cells, experts, PLAIN, agent))
    steps = [n for entry in _entries(cells, experts, way, agent) for n in entry["steps"]]
    return {
        **_plain_row(loops, experts, way, agent, maze_estimate(rewards), gain),
        "advised": round(float(np.mean(_advised(cells, experts, way, agent))), 1),
        "median_steps": float(np.median(steps)),
    }


def _plain_row(loops: float, experts: str, way: str, agent: str, reward: Estimate, gain: Estimate | None) -> dict:
    row = {"loops": loops, "experts": experts, "way": way, "agent": agent, "reward": round(reward.value, 1)}
    row["ci95"] = [round(x, 1) for x in reward.ci95] if reward.ci95 else None
    if gain is not None:
        row |= {
            "gain": round(gain.value, 1),
            "gain_is_certain": bool(gain.ci95 and gain.ci95[0] * gain.ci95[1] > 0),
        }
    return row
