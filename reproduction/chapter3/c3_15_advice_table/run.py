"""C3.15: explorers and Q-learning in a maze without advice, with the thesis's advice and with a better advisor's.

Table 3.1 depends on two unprinted choices: how the maze loops, and how its experts walked. Both are crossed; one
stated default is the headline. The better advisor goes beyond the thesis: its conditions are reported and take no
part in the verdict. Other buildings, and α⁰ in the advice, are run beside the default.
Thesis: §3.7.2.2, Table 3.1, one-shot tasks of up to 5,000 steps.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from lifelore.action.advice.advisor import BETTER as BETTER_SETTINGS
from lifelore.action.advice.advisor import Advisor, exploration_rows
from lifelore.action.advice.behaviour_models import Tabulated
from lifelore.action.advice.goal_model import GoalModel, extend_goal_models
from lifelore.core.errors import InputError
from lifelore.domains.advice.explorers import EXPLORERS, explorer_probs
from lifelore.domains.grids.grid_world import GridWorld
from reproduction.chapter3.advice import buildings, mazes
from reproduction.chapter3.advice.learning import learn_errands
from reproduction.chapter3.advice.mazes import AGENTS, Maze, goal_models_of, thesis_advisor

__all__ = ["cells", "check", "run_cell"]
NONE, THESIS, BETTER, UNIFORM_ONLY, GOAL_UNKNOWN = "none", "thesis", "better", "uniform only", "goal unknown"
"""Advisors: none; the thesis's; the better one; the better one with Uniform as its only other model; the better
one without experts of the agent's own goal."""
LEARNER = "q-learning"
Q_LEARNING = {"tasks", "episodes", "max_episode_steps", "learning_rate", "last", "schedule"}


def cells(settings: Mapping) -> list[dict]:
    """The mazes of the grid, then those of the buildings beside it."""
    return mazes.maze_cells(settings) + buildings.building_cells(settings)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: all agents unadvised and under each advisor of each kind of experts; and Q-learning."""
    if "building" in cell:
        return _in_building(settings, cell, seed)
    maze = mazes.maze_of(settings, cell, seed)
    silent = thesis_advisor(settings, goal_models_of(settings, maze, "policies"))
    walks = _walks(settings, maze, silent, None, NONE, heeds=False)
    learners = [{"experts": None, "final": _final_rewards(settings, maze, None)}]
    for experts in settings["experts"]:
        purposes = goal_models_of(settings, maze, experts)
        advisors = {
            THESIS: thesis_advisor(settings, purposes),
            BETTER: better_advisor(settings, maze.world, purposes),
            UNIFORM_ONLY: better_advisor(settings, maze.world, purposes, explorers=False),
        }
        for way, advisor in advisors.items():
            walks += _walks(settings, maze, advisor, experts, way)
        if {"loops": cell["loops"], "experts": experts} == settings["default"]:
            others = {goal: [p for p in purposes if goal not in p.goals] for goal in maze.errands}
            lacking = {goal: better_advisor(settings, maze.world, known) for goal, known in others.items()}
            walks += _walks(settings, maze, lacking, experts, GOAL_UNKNOWN)
        learners.append({"experts": experts, "final": _final_rewards(settings, maze, GoalModel.pooled(purposes))})
    return {**cell, "walks": walks, "learners": learners}


def _in_building(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze of a building: every agent and Q-learning, unadvised and with the thesis's advice by α⁰."""
    maze = buildings.building_of(settings, cell, seed)
    purposes = goal_models_of(settings, maze, settings["default"]["experts"])
    found = _rewards(settings, maze, purposes, None)
    for alpha0 in buildings.advised_alpha0(settings, cell):
        found += _rewards(settings, maze, purposes, alpha0)
    size = settings["buildings"][cell["building"]]["size"]
    return {**cell, "walls": 1 - maze.world.n_states / size**2, "rewards": found}


def _rewards(settings: Mapping, maze: Maze, purposes: Sequence[GoalModel], alpha0: float | None) -> list[dict]:
    """Each agent's mean reward with the advice's `alpha0`, None: without advice; Q-learning last."""
    advisor = thesis_advisor(settings, purposes, alpha0=alpha0 or 0.0)
    pooled = None if alpha0 is None else replace(GoalModel.pooled(purposes), advised_alpha0=alpha0)
    walks = _walks(settings, maze, advisor, None, "", heeds=alpha0 is not None)
    found = {of_agent["agent"]: 1000 * float(np.mean(of_agent["reached"])) for of_agent in walks}
    found[LEARNER] = float(np.mean(_final_rewards(settings, maze, pooled, buildings.STARTS)))
    return [{"alpha0": alpha0, "agent": agent, "reward": reward} for agent, reward in found.items()]


def better_advisor(settings: Mapping, world: GridWorld, purposes: Sequence[GoalModel], explorers=True) -> Advisor:
    """Goals apart, at most 40 steps in 100 advised; `explorers`: whether it knows how each of them walks."""
    chosen = replace(BETTER_SETTINGS, kappa=settings["kappa"], window=settings["window"])
    others = None
    if explorers:
        bugs = [Tabulated(explorer_probs(world, "bug", purpose.goals[0])) for purpose in purposes]
        others = [*(Tabulated(explorer_probs(world, name)) for name in EXPLORERS if name != "bug"), bugs]
    return Advisor(extend_goal_models(purposes, world.neighbour), others, chosen)


def _walks(
    settings: Mapping, maze: Maze, advisor, experts: str | None, way: str, heeds: bool = True
) -> list[dict]:
    """Each agent's errands: whether the goal was reached, in how many steps, and how many were advised."""
    found = []
    for agent in AGENTS:
        walks = mazes.walks_of(settings, maze, mazes.policies_of(settings, maze, agent), advisor, heeds)
        numbers = {"reached": [int(w.reached) for w in walks], "steps": [len(w.states) for w in walks]}
        numbers["advised"] = [int(w.advised.sum()) for w in walks]
        found.append({"experts": experts, "way": way, "agent": agent, **numbers})
    return found


def _final_rewards(settings: Mapping, maze: Maze, pooled: GoalModel | None, starts: str = "one") -> list[float]:
    """Q-learning's mean reward over the last episodes of each task, of 1000."""
    learning = settings["q_learning"]
    advice = None if pooled is None else exploration_rows(pooled, settings["kappa"])
    learnt = learn_errands(learning, maze, starts, learning["schedule"], advice)
    return [float(1000 * curve.reached[-learning["last"] :].mean()) for _, curve in learnt]


def check(settings: Mapping) -> None:
    """Refuse settings of Q-learning and buildings that limits cannot describe."""
    buildings.check_buildings(settings["buildings"], settings)
    learning = settings["q_learning"]
    if set(learning) != Q_LEARNING:
        keys = ", ".join(sorted(Q_LEARNING))
        raise InputError(f"q_learning must have exactly {keys}, got {', '.join(learning)}")
    if not 1 <= learning["tasks"] <= settings["tasks"] or not 1 <= learning["last"] <= learning["episodes"]:
        bounds = f"tasks in [1, {settings['tasks']}] and last in [1, episodes]"
        raise InputError(f"q_learning must have {bounds}, got {learning}")
