"""C3.15: Table 3.1, explorers and Q-learning in a maze with advice and without, and the better advisor beside.

What decides the table is not printed: how the maze loops, and how its experts walked. Both are crossed, and one
stated default is the headline. The better advisor goes beyond the thesis: what is asked of it is reported, and
takes no part in the verdict. Thesis: §3.7.2, Table 3.1.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.domains.advice.explorers import EXPLORERS
from lifelore.experiments.chapter3.advice_estimates import (
    at,
    check_grid,
    grid_of,
    is_positive,
    maze_estimate,
    picked,
    plain,
    share_of_grid,
)
from lifelore.experiments.chapter3.advice_grid import AGENTS, GRID, SMALL, maze_cells
from lifelore.experiments.chapter3.advised_explorers import (
    BETTER,
    GOAL_UNKNOWN,
    PLAIN,
    THESIS,
    UNIFORM_ONLY,
    run_cell,
)
from lifelore.experiments.chapter3.advised_learning import LEARNING
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.predicate import Predicate

WAYS = (PLAIN, THESIS, BETTER, UNIFORM_ONLY)
GOAL = 700
PRINTED = {
    "random": (50, 900),
    "avoid": (50, 750),
    "left": (150, 750),
    "bug": (100, 800),
    "q-learning": (150, 1000),
    "optimal": (1000, 1000),
}
"""Table 3.1: without and with advice."""
Q_LEARNING = {**LEARNING, "schedule": [1.0, 0.999, 0.05]}
FULL = {**GRID, "mazes": 16, "tasks": 20, "max_steps": 5000, "q_learning": Q_LEARNING}
QUICK = {
    **FULL,
    **SMALL,
    "mazes": 3,
    "tasks": 4,
    "max_steps": 600,
    "q_learning": {**Q_LEARNING, "tasks": 2, "episodes": 100, "max_episode_steps": 40, "last": 20},
}
CAUSES = {
    "all four rise": "one prior over eight goals points to none of them: between two goals its common actions "
    "cancel, and near one it leads there whatever the agent's own",
    "as high as printed": "a walk down one prior ends at one of eight goals; the printed rewards would need "
    "agents that are started again, as the learner is",
    "learning to the end": "episodes of one task start in one cell, and the prior leads from there to some goals "
    "and away from others, with no reward to tell",
    "optimal stays": "between the ways to eight goals an optimal step to one of them can look like chance; what "
    "is then advised leads elsewhere",
    "better reaches 700": "the experts' walks left part of the maze unseen, where no advisor can say anything",
    "better without knowing explorers": "a purposeful agent that goes wrong is no uniform one: the advisor takes "
    "it for an expert, and says little",
}


def _check(settings: Mapping) -> None:
    check_grid(settings, ("tasks", "max_steps"))
    learning = settings["q_learning"]
    if set(learning) != set(Q_LEARNING):
        raise InputError(f"q_learning must have exactly {', '.join(Q_LEARNING)}, got {', '.join(learning)}")
    if not 1 <= learning["tasks"] <= settings["tasks"] or not 1 <= learning["last"] <= learning["episodes"]:
        raise InputError(
            f"q_learning must have tasks in [1, {settings['tasks']}] and last in [1, episodes], got {learning}"
        )


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


def _draw(result: Mapping):
    from lifelore.experiments.chapter3.c3_15_advice_table.figure_advice_bars import draw_advice_bars

    return draw_advice_bars(result, PRINTED)


CLAIM = Claim(
    id="C3.15",
    title="Advice to explorers in a maze (Table 3.1)",
    thesis="In a 30×30 maze with eight goals, over 20 tasks of up to 5,000 steps (κ = 0.5, window 300), advice "
    "raises the reward of random motion from 50 to 900, of random motion with obstacle avoidance from 50 to 750, "
    "of always turning left from 150 to 750, of a goal-seeking bug from 100 to 800, of Q-learning (5,000 episodes "
    "of 200 steps) from 150 to 1000; optimal trajectories receive 1000 either way.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C3.15"),
    cells=maze_cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=_check,
)
