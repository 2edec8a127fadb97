"""Mazes, experts, errands, agents and the thesis's advisor of claims C3.15 to C3.18, and estimates over mazes.

The thesis draws one maze and prints neither how it loops nor where its experts began: readings cross loop
densities with kinds of experts and α⁰, over many mazes. An interval is over mazes, since the errands of one maze
share its experts. Experts take shortest paths, as converged policies do. There is one θ: it is advised, and it is
M₁. Everything compared in an errand shares its start and its random numbers. Thesis: §3.7.2.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.advice.advisor import AdviceSettings, Advisor
from lifelore.action.advice.goal_model import GoalModel, Trajectory
from lifelore.core.learning.known_world import GOAL, goal_distances
from lifelore.core.mdp import Tables
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.advice.advice_maze import advice_maze, errand, maze_goals
from lifelore.domains.advice.explorers import EXPLORERS, explorer_probs
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.figures.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, VERMILION
from reproduction.chapter3.advice.advised_walk import Walk, advised_walk
from reproduction.engine.grid import combinations

NO_PSEUDO_COUNT = 1e-9
"""α⁰ of M₁ where θ has none: an action that no expert took is next to impossible, not impossible."""
EXPERT_WALKS = 20
"""Walks of experts to each goal."""
KAPPA, WINDOW = 0.5, 300
"""The thesis's cost of advice, and the steps of H (§3.7.2.3)."""
AGENTS = (*EXPLORERS, "optimal")
EXPLORER_WORDS = {
    "random": "random motion",
    "avoid": "random, avoiding obstacles",
    "left": "always left",
    "bug": "goal-seeking bug",
}
AGENT_WORDS = {**EXPLORER_WORDS, "q_learning": "Q-learning", "optimal": "optimal"}
AGENT_COLOURS = dict(zip(AGENT_WORDS, (VERMILION, ORANGE, GREEN, PURPLE, BLUE, INK), strict=True))
ADVICE_COLOURS = {"without advice": GREY, "with advice": VERMILION, "goals apart (ours)": BLUE}
"""Names and colours of agents, and colours of ways to be advised, in the figures on advice."""
ROUNDING = 12
"""Decimals of a maze's number: a difference that is only rounding must not pass for a certain gain."""


class Errand(NamedTuple):
    """One task of the maze: its goal, tables, the best moves of every state, and the steps left from there.

    best : (n_states, 4) bool, none at the goal
    steps : (n_states,) float64
    moves : (n_states, 4) int32, where each move leads, -1 where it is refused
    """

    goal: int
    tables: Tables
    best: NDArray[np.bool_]
    steps: NDArray[np.float64]
    moves: NDArray[np.int32]


class Maze(NamedTuple):
    """A maze, the errand to each of its goals, and the names of its streams."""

    world: GridWorld
    errands: dict[int, Errand]
    names: tuple


def maze_cells(settings: Mapping) -> list[dict]:
    """A cell for each maze of each loop density."""
    return [{"loops": loops, "maze": number} for loops in settings["loops"] for number in range(settings["mazes"])]


def choices_of(settings: Mapping) -> list[dict]:
    """Kinds of experts crossed with α⁰, what is measured in one maze; the first makes the default."""
    return combinations(settings, ("experts", "alpha0"))


def readings_of(settings: Mapping) -> list[tuple[dict, float, int]]:
    """Every reading, its loop density and the place of its choice in `choices_of`; the default first."""
    choices = choices_of(settings)
    return [({"loops": n, **choice}, n, place) for n in settings["loops"] for place, choice in enumerate(choices)]


def maze_of(settings: Mapping, cell: Mapping, seed: int) -> Maze:
    """The maze of a cell."""
    names = (seed, "advice", f"{cell['loops']:g}", cell["maze"])
    world = advice_maze(stream(*names, "maze"), settings["size"], cell["loops"])
    return Maze(world, {int(goal): errand_to(world, int(goal)) for goal in maze_goals(world)}, names)


def errand_to(world: GridWorld, goal: int) -> Errand:
    """The errand to a goal; equally good moves are all best."""
    place = np.zeros(world.n_states, np.int8)
    place[goal] = GOAL
    task = errand(world, goal)
    moves = task.params[0]
    steps = goal_distances(moves, place).astype(float)
    best = (moves >= 0) & (steps[moves] == steps[:, None] - 1) & (steps[:, None] > 0)
    return Errand(goal, task.tables(), best, steps, moves)


def errands_of(maze: Maze, n: int) -> list[Errand]:
    """The goals of `n` agents, drawn with repeats."""
    goals = list(maze.errands)
    drawn = stream(*maze.names, "errands").integers(0, len(goals), n)
    return [maze.errands[goals[i]] for i in drawn]


def goal_models_of(maze: Maze, experts: str, alpha0: float) -> list[GoalModel]:
    """The goal models of experts of a kind, one for each goal; θ has `alpha0`, advised or not."""
    models = []
    for goal, found in maze.errands.items():
        random = stream(*maze.names, "experts", experts, goal)
        others = np.array([other for other in maze.errands if other != goal])
        starts = random.choice(others if experts == "trips" else found.tables.starts, EXPERT_WALKS)
        walks = [expert_walk(maze.world, found, int(start), random) for start in starts]
        in_prior = max(alpha0, NO_PSEUDO_COUNT)
        model = GoalModel.from_trajectories(walks, maze.world.n_states, 4, [goal], in_prior)
        models.append(replace(model, advised_alpha0=alpha0))
    return models


def expert_walk(world: GridWorld, found: Errand, start: int, random: np.random.Generator) -> Trajectory:
    """A shortest path from `start`, drawn among equal moves step by step."""
    states, actions = [start], []
    while states[-1] != found.goal:
        ways = np.flatnonzero(found.best[states[-1]])
        actions.append(int(ways[0] if len(ways) == 1 else random.choice(ways)))
        states.append(int(world.neighbour[states[-1], actions[-1]]))
    return Trajectory(np.array(states), np.array(actions))


def thesis_advisor(purposes: Sequence[GoalModel], kappa: float = KAPPA) -> Advisor:
    """M₁ pooled over all goals, M₂ uniform."""
    return Advisor([GoalModel.pooled(purposes)], None, AdviceSettings(kappa, WINDOW))


def policy_of(world: GridWorld, agent: str, found: Errand) -> NDArray[np.float64]:
    """The action probabilities of one of `AGENTS` on an errand."""
    if agent == "optimal":
        chosen = found.best | ~found.best.any(axis=1, keepdims=True)
        return chosen / chosen.sum(axis=1, keepdims=True)
    world = replace(world, neighbour=found.moves)
    return explorer_probs(world, agent, found.goal if agent == "bug" else None)


def policies_of(settings: Mapping, maze: Maze, agent: str) -> list[NDArray[np.float64]]:
    """The action probabilities of one of `AGENTS` on each errand of a maze."""
    return [policy_of(maze.world, agent, found) for found in errands_of(maze, settings["tasks"])]


def walks_of(
    settings: Mapping,
    maze: Maze,
    policies: Sequence[NDArray[np.float64]],
    advisor: Advisor,
    heeds: bool = True,
) -> list[Walk]:
    """An agent's walks on all errands, with a policy for each; every agent meets the same random numbers."""
    tables = [found.tables for found in errands_of(maze, settings["tasks"])]
    randoms = [stream(*maze.names, "walk", number) for number in range(len(tables))]
    return [
        advised_walk(task, policy, advisor, random, settings["max_steps"], follows_advice=heeds)
        for task, policy, random in zip(tables, policies, randoms, strict=True)
    ]


def maze_estimate(values: ArrayLike) -> Estimate:
    """Mean over mazes."""
    return mean_estimate(np.round(np.asarray(values, float), ROUNDING))
