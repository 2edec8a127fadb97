"""C3.15: explorers and Q-learning in a maze without advice, with the thesis's advice and with a better advisor's.

Table 3.1 depends on two unprinted choices: how the maze loops, and how its experts walked. Both are crossed; one
stated default is the headline. The better advisor goes beyond the thesis: its conditions are reported and take no
part in the verdict. Thesis: §3.7.2.2, Table 3.1, one-shot tasks of up to 5,000 steps.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from lifelore.action.advice.advisor import BETTER as BETTER_SETTINGS
from lifelore.action.advice.advisor import Advisor, exploration_rows
from lifelore.action.advice.behaviour_models import Tabulated
from lifelore.action.advice.goal_model import GoalModel, extend_goal_models
from lifelore.core.errors import InputError
from lifelore.domains.advice.explorers import EXPLORERS, explorer_probs
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.experiments.chapter3.advice.learning import errand_tables, learn_errand
from lifelore.experiments.chapter3.advice.mazes import (
    AGENTS,
    Maze,
    errands_of,
    goal_models_of,
    maze_of,
    policy_of,
    thesis_advisor,
    walk,
)
from lifelore.experiments.chapter3.advice.mazes import maze_cells as cells

__all__ = ["cells", "check", "run_cell"]
NONE, THESIS, BETTER, UNIFORM_ONLY, GOAL_UNKNOWN = "none", "thesis", "better", "uniform only", "goal unknown"
"""Advisors: none; the thesis's; the better one; the better one with Uniform as its only other model; the better
one without experts of the agent's own goal."""
Q_LEARNING = {"tasks", "episodes", "max_episode_steps", "learning_rate", "last", "schedule"}


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: all agents unadvised and under each advisor of each kind of experts; and Q-learning."""
    maze = maze_of(settings, cell, seed)
    silent = thesis_advisor(settings, goal_models_of(settings, maze, "policies"))
    walks = _walks(settings, maze, dict.fromkeys(maze.errands, silent), None, NONE, heeds=False)
    learners = [{"experts": None, "final": _final_rewards(settings, maze, None)}]
    for experts in settings["experts"]:
        purposes = goal_models_of(settings, maze, experts)
        advisors = {
            THESIS: thesis_advisor(settings, purposes),
            BETTER: better_advisor(settings, maze.world, purposes),
            UNIFORM_ONLY: better_advisor(settings, maze.world, purposes, explorers=False),
        }
        for way, advisor in advisors.items():
            walks += _walks(settings, maze, dict.fromkeys(maze.errands, advisor), experts, way)
        if {"loops": cell["loops"], "experts": experts} == settings["default"]:
            others = {goal: [p for p in purposes if goal not in p.goals] for goal in maze.errands}
            lacking = {goal: better_advisor(settings, maze.world, known) for goal, known in others.items()}
            walks += _walks(settings, maze, lacking, experts, GOAL_UNKNOWN)
        learners.append({"experts": experts, "final": _final_rewards(settings, maze, GoalModel.pooled(purposes))})
    return {**cell, "walks": walks, "learners": learners}


def better_advisor(
    settings: Mapping, world: GridWorld, purposes: Sequence[GoalModel], explorers: bool = True
) -> Advisor:
    """Goals apart, at most 40 steps in 100 advised; `explorers`: whether it knows how each of them walks."""
    chosen = replace(BETTER_SETTINGS, kappa=settings["kappa"], window=settings["window"])
    others = None
    if explorers:
        bugs = [Tabulated(explorer_probs(world, "bug", purpose.goals[0])) for purpose in purposes]
        others = [*(Tabulated(explorer_probs(world, name)) for name in EXPLORERS if name != "bug"), bugs]
    return Advisor(extend_goal_models(purposes, world.neighbour), others, chosen)


def _walks(
    settings: Mapping,
    maze: Maze,
    advisors: Mapping[int, Advisor],
    experts: str | None,
    way: str,
    heeds: bool = True,
) -> list[dict]:
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


def _final_rewards(settings: Mapping, maze: Maze, pooled: GoalModel | None) -> list[float]:
    """Q-learning's mean reward over the last episodes of each task, of 1000."""
    learning = settings["q_learning"]
    advice = None if pooled is None else exploration_rows(pooled, settings["kappa"])
    final = []
    for number, errand in enumerate(errands_of(maze, learning["tasks"])):
        tables = errand_tables(maze, errand, number, "one")
        reached = learn_errand(learning, maze, tables, number, learning["schedule"], advice)[1].reached
        final.append(float(1000 * reached[-learning["last"] :].mean()))
    return final


def check(settings: Mapping) -> None:
    learning = settings["q_learning"]
    if set(learning) != Q_LEARNING:
        raise InputError(
            f"q_learning must have exactly {', '.join(sorted(Q_LEARNING))}, got {', '.join(learning)}"
        )
    if not 1 <= learning["tasks"] <= settings["tasks"] or not 1 <= learning["last"] <= learning["episodes"]:
        raise InputError(
            f"q_learning must have tasks in [1, {settings['tasks']}] and last in [1, episodes], got {learning}"
        )
