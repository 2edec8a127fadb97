"""Explorers of fixed policy sent on errands, each alone and under every advisor: the cells of C3.15 and C3.18.

Thesis: §3.7.2.2, one-shot tasks of up to 5,000 steps.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.action.advice.advised_walk import Walk
from lifelore.action.advice.advisor import Advisor, exploration_rows
from lifelore.action.advice.goal_model import GoalModel
from lifelore.domains.advice.explorers import EXPLORERS
from lifelore.experiments.chapter3.advice_grid import (
    AGENTS,
    Maze,
    better_advisor,
    errands_of,
    maze_of,
    policy_of,
    purposes_of,
    thesis_advisor,
    walk,
)
from lifelore.experiments.chapter3.advised_learning import errand_tables, learn_errand, learnt

PLAIN, THESIS, BETTER, UNIFORM_ONLY, GOAL_UNKNOWN = "none", "thesis", "better", "uniform only", "goal unknown"
"""Who advises: nobody; the thesis's advisor; the better one; it with Uniform as its only other model; it where
experts of the agent's own goal were never seen."""


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """C3.15, one maze: all agents unadvised and under each advisor of each kind of experts; and Q-learning."""
    maze = maze_of(settings, cell, seed)
    walks, learners = _unadvised(settings, maze), _learners(settings, maze, None)
    for experts in settings["experts"]:
        purposes = purposes_of(settings, maze, experts)
        watching = {
            THESIS: thesis_advisor(settings, purposes),
            BETTER: better_advisor(settings, maze.world, purposes),
            UNIFORM_ONLY: better_advisor(settings, maze.world, purposes, explorers=False),
        }
        for way, advisor in watching.items():
            walks += _walks(settings, maze, dict.fromkeys(maze.errands, advisor), experts, way)
        if {"loops": cell["loops"], "experts": experts} == settings["default"]:
            walks += _walks(settings, maze, _lacking(settings, maze, purposes), experts, GOAL_UNKNOWN)
        learners += _learners(settings, maze, experts, GoalModel.pooled(purposes))
    return {**cell, "walks": walks, "learners": learners}


def _lacking(settings: Mapping, maze: Maze, purposes: Sequence[GoalModel]) -> dict[int, Advisor]:
    """For each goal a better advisor who saw only the experts bound for the others."""
    return {
        goal: better_advisor(settings, maze.world, [p for p in purposes if goal not in p.goals])
        for goal in maze.errands
    }


def _unadvised(settings: Mapping, maze: Maze) -> list[dict]:
    advisor = thesis_advisor(settings, purposes_of(settings, maze, "policies"))
    return _walks(settings, maze, dict.fromkeys(maze.errands, advisor), None, PLAIN, heeds=False)


def _walks(settings, maze: Maze, advisors: Mapping[int, Advisor], experts, way: str, heeds: bool = True) -> list:
    """Each agent's errands: whether the goal was reached, in how many steps, and how many were advised."""
    found = []
    for agent in AGENTS:
        entry = {"experts": experts, "way": way, "agent": agent, "reached": [], "steps": [], "advised": []}
        for number, errand in enumerate(errands_of(maze, settings["tasks"])):
            policy = policy_of(maze.world, agent, errand)
            walked = walk(maze, errand, policy, advisors[errand.goal], number, settings["max_steps"], heeds)
            entry["reached"].append(int(walked.reached))
            entry["steps"].append(len(walked.states))
            entry["advised"].append(int(walked.advised.sum()))
        found.append(entry)
    return found


def _learners(settings: Mapping, maze: Maze, experts: str | None, pooled: GoalModel | None = None) -> list[dict]:
    learning = settings["q_learning"]
    advice = None if pooled is None else exploration_rows(pooled, settings["kappa"])
    final = []
    for number, errand in enumerate(errands_of(maze, learning["tasks"])):
        tables = errand_tables(maze, errand, number, "one")
        curve = learn_errand(learning, maze, tables, number, learning["schedule"], advice)[1]
        final.append(learnt(learning, curve.reached)["final"])
    return [{"experts": experts, "final": final}]


def run_normalcy_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """C3.18, one maze: P(M₁ | H) of each explorer, told and not, under the thesis's advisor."""
    maze = maze_of(settings, cell, seed)
    found = []
    for experts in settings["experts"]:
        advisor = thesis_advisor(settings, purposes_of(settings, maze, experts))
        for explorer in EXPLORERS:
            found.append({"experts": experts, "agent": explorer} | _normalcy(settings, maze, advisor, explorer))
    return {**cell, "explorers": found}


def _normalcy(settings: Mapping, maze: Maze, advisor: Advisor, explorer: str) -> dict:
    pairs = []
    for number, errand in enumerate(errands_of(maze, settings["tasks"])):
        policy = policy_of(maze.world, explorer, errand)
        pairs.append(
            [walk(maze, errand, policy, advisor, number, settings["max_steps"], heeds) for heeds in (False, True)]
        )
    alone, told = ([pair[i] for pair in pairs] for i in (0, 1))
    n_blocks, length = settings["blocks"], settings["max_steps"] // settings["blocks"]
    return {
        "alone": [float(w.p_normal.mean()) for w in alone],
        "told": [float(w.p_normal.mean()) for w in told],
        "own": [own_normalcy(advisor, w) for w in told],
        "unadvised": [unadvised_normalcy(w) for w in told],
        "advised_share": [float(w.advised.mean()) for w in told],
        "curve_alone": block_curve(alone, n_blocks, length),
        "curve_told": block_curve(told, n_blocks, length),
    }


def own_normalcy(advisor: Advisor, walked: Walk) -> float:
    """Mean P(M₁ | H) of a walk when H holds only the steps that the agent chose itself."""
    return float(advisor.assess(walked.states, np.where(walked.advised, -1, walked.actions)).p_normal.mean())


def unadvised_normalcy(walked: Walk) -> float | None:
    """Mean P(M₁ | H), advised steps in H, over the steps that were not advised; None where all were."""
    kept = walked.p_normal[~walked.advised]
    return float(kept.mean()) if kept.size else None


def block_curve(walks: Sequence[Walk], n_blocks: int, length: int) -> dict:
    """By blocks of steps: the sum of P(M₁ | H), the steps still walked, and the walks at their goal by then."""
    p, n, reached = np.zeros(n_blocks), np.zeros(n_blocks, int), np.zeros(n_blocks, int)
    for walked in walks:
        block = np.arange(len(walked.states)) // length
        p += np.bincount(block, walked.p_normal, n_blocks)
        n += np.bincount(block, minlength=n_blocks)
        if walked.reached:
            reached[block[-1] :] += 1
    return {"p": np.round(p, 6).tolist(), "n": n.tolist(), "reached": reached.tolist()}
