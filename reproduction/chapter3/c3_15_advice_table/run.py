"""C3.15: explorers, an optimal agent and Q-learning in a maze, without advice and with the thesis's advice.

An advisor that keeps the goals apart, which goes beyond the thesis, is shown beside it.
Thesis: §3.7.2.2, Table 3.1, one-shot tasks of up to 5,000 steps.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from lifelore.action.advice.advisor import BETTER, Advisor
from lifelore.action.advice.goal_model import extend_goal_models
from lifelore.core.metrics import Estimate
from lifelore.domains.advice.explorers import EXPLORERS
from lifelore.figures.style import INK, Axes
from reproduction.chapter3.advice import mazes
from reproduction.chapter3.advice.learning import errand_tables, final_reward, learner_schedule, reached_by_learner
from reproduction.chapter3.advice.mazes import ADVICE_COLOURS, AGENT_WORDS, AGENTS, KAPPA, WINDOW, Maze
from reproduction.chapter3.learning.schedules import PRINTED
from reproduction.engine.records import having
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

cells = mazes.maze_cells
LEARNER = "q_learning"
LEARNT = 5
"""Tasks of a maze that are learnt."""


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: every agent's mean reward alone, advised by choice, and with goals kept apart.

    Q-learning is advised at the default loop density, elsewhere in ``reading_mazes`` mazes.
    """
    maze = mazes.maze_of(settings, cell, seed)
    learns = cell["loops"] == settings["loops"][0] or cell["maze"] < settings["reading_mazes"]
    each = [mazes.goal_models_of(maze, **choice) for choice in mazes.choices_of(settings)]
    return {
        **cell,
        "alone": rewards(settings, maze, mazes.thesis_advisor(each[0], float("inf")), learns),
        "advised": [rewards(settings, maze, mazes.thesis_advisor(purposes), learns) for purposes in each],
        "apart": rewards(settings, maze, goals_apart(maze, each[0]), False),
    }


def rewards(settings: Mapping, maze: Maze, advisor: Advisor, learns: bool) -> dict[str, float]:
    """Each agent's mean reward under an advisor, of 1000."""
    found = {}
    for agent in AGENTS:
        walks = mazes.walks_of(settings, maze, mazes.policies_of(settings, maze, agent), advisor)
        found[agent] = 1000 * float(np.mean([walk.reached for walk in walks]))
    if learns:
        schedule, learnt = learner_schedule(settings, maze, PRINTED), []
        for number, errand in enumerate(mazes.errands_of(maze, min(LEARNT, settings["tasks"]))):
            tables = errand_tables(maze, errand, number, "one")
            learnt.append(final_reward(reached_by_learner(maze, tables, number, schedule, advisor)))
        found[LEARNER] = float(np.mean(learnt))
    return found


def goals_apart(maze: Maze, purposes: Sequence) -> Advisor:
    """A model for each goal, the path to one goal advised at a time; at most 40 steps in 100 advised."""
    settings = replace(BETTER, kappa=KAPPA, window=WINDOW)
    return Advisor(extend_goal_models(purposes, maze.world.neighbour), None, settings)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Rewards at the default."""
    own = having(results, loops=settings["loops"][0])
    advised = [result["advised"][0] for result in own]
    return {
        "explorers_alone": _mean_of_explorers([result["alone"] for result in own]),
        "explorers_advised": _mean_of_explorers(advised),
        "explorers_apart": _mean_of_explorers([result["apart"] for result in own]),
        "q_learning_advised": mazes.maze_estimate([rewards[LEARNER] for rewards in advised]),
        "optimal_advised": mazes.maze_estimate([rewards["optimal"] for rewards in advised]),
    }


def _gains(results: Sequence[Mapping], place: int) -> dict[str, Estimate]:
    """What advice adds to each agent's reward, by maze."""
    pairs = [(result["advised"][place], result["alone"]) for result in results]
    return {
        f"gain_{agent}": mazes.maze_estimate(
            [advised[agent] - alone[agent] for advised, alone in pairs if agent in alone]
        )
        for agent in (*EXPLORERS, LEARNER)
    }


def _mean_of_explorers(rewards: Sequence[Mapping]) -> Estimate:
    return mazes.maze_estimate([np.mean([of_maze[agent] for agent in EXPLORERS]) for of_maze in rewards])


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """What advice adds, by loop density, kind of experts and α⁰."""
    for reading, loops, place in mazes.readings_of(settings):
        yield reading, _gains(having(results, loops=loops), place)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Each agent's reward alone, advised and with goals apart, at the default."""
    own = having(results, loops=settings["loops"][0])
    found = []
    for agent in (*EXPLORERS, LEARNER, "optimal"):
        ways = {"alone": [r["alone"] for r in own], "advised": [r["advised"][0] for r in own]}
        if agent != LEARNER:
            ways["apart"] = [result["apart"] for result in own]
        numbers = {way: mazes.maze_estimate([of[agent] for of in each]).to_dict() for way, each in ways.items()}
        found.append({"agent": agent, **numbers})
    return found


WAYS = dict(zip(("alone", "advised", "apart"), ADVICE_COLOURS, strict=True))
TABLE = {
    "random": (50, 900),
    "avoid": (50, 750),
    "left": (150, 750),
    "bug": (100, 800),
    "q_learning": (150, 1000),
    "optimal": (1000, 1000),
}
"""Table 3.1: reward without advice and with it."""


@panels(6.8, 4.6, grid="x")
def draw(result: Mapping, axes: Axes) -> None:
    """Figure of claim C3.15: the thesis's Table 3.1 as bars, the printed rewards beside ours.

    The figure from the result: agents downwards.
    """
    rows = result["rows"]
    groups = {label: [row.get(way) for row in rows] for way, label in WAYS.items()}
    names = [AGENT_WORDS[row["agent"]] for row in rows]
    draw_interval_bars(
        axes, names, groups, colours=ADVICE_COLOURS, words=None, label="mean reward, of 1000", legend=False
    )
    height = 0.8 / len(groups)
    for place, row in enumerate(rows):
        for way, reward in enumerate(TABLE[row["agent"]]):
            label = "thesis" if place == way == 0 else None
            axes.plot(
                reward, place + (way - 1) * height, "D", ms=5, mfc="none", color=INK, clip_on=False, label=label
            )
    axes.set_xlim(0, 1000)
    axes.figure.legend(*axes.get_legend_handles_labels(), loc="outside lower left", ncols=4)
