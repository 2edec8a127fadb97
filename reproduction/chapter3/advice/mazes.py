"""Mazes, experts, errands, agents and the thesis's advisor of claims C3.15 to C3.18, and estimates over mazes.

The thesis draws one maze and does not say how its experts walked. The claims cross loop densities with kinds of
experts, over many mazes; an interval is over mazes, since the errands of one maze share its experts. Experts take
shortest paths, as converged policies do. Everything compared in an errand shares its start and its random numbers.
Thesis: §3.7.2.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.advice.advised_walk import Walk, advised_walk
from lifelore.action.advice.advisor import AdviceSettings, Advisor
from lifelore.action.advice.goal_model import GoalModel, Trajectory
from lifelore.core.learning.known_world import GOAL, goal_distances
from lifelore.core.mdp import Tables
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.advice.advice_maze import advice_maze, errand, maze_goals
from lifelore.domains.advice.explorers import EXPLORERS, explorer_probs
from lifelore.domains.grids.grid_world import GridWorld
from reproduction.engine.estimates import exact_value

EXPERTS = ("walks", "few walks", "trips", "policies")
"""Walks to each goal from anywhere, few of them, walks from other goals; or the best actions of every state."""
AGENTS = (*EXPLORERS, "optimal")
ROUNDING = 12
"""Decimals of a maze's number: a difference that is only rounding must not pass for a certain gain."""


class Errand(NamedTuple):
    """One task of the maze: its goal, tables, the best moves of every state, and the steps left from there.

    best : (n_states, 4) bool, none at the goal
    steps : (n_states,) float64, -1 where closed goals bar the way
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


def grid_of(settings: Mapping) -> list[tuple[float, str]]:
    """Loop densities crossed with kinds of experts."""
    return list(product(settings["loops"], settings["experts"]))


def maze_of(settings: Mapping, cell: Mapping, seed: int, others: str = "pass") -> Maze:
    """The maze of a cell; goals that closed other goals wall in have no errand."""
    names = (seed, "advice", f"{cell['loops']:g}", cell["maze"])
    world = advice_maze(stream(*names, "maze"), settings["size"], cell["loops"])
    errands = [errand_to(world, int(goal), others) for goal in maze_goals(world)]
    return Maze(world, {found.goal: found for found in errands if found.tables.starts.size}, names)


def errand_to(world: GridWorld, goal: int, others: str = "pass") -> Errand:
    """The errand to a goal, from where it can be reached; equally good moves are all best."""
    place = np.zeros(world.n_states, np.int8)
    place[goal] = GOAL
    tables = errand(world, goal, others).tables()
    moves = errand(world, goal, others).params[0]
    steps = goal_distances(moves, place).astype(float)
    best = (moves >= 0) & (steps[moves] == steps[:, None] - 1) & (steps[:, None] > 0)
    return Errand(goal, tables._replace(starts=tables.starts[steps[tables.starts] > 0]), best, steps, moves)


def errands_of(maze: Maze, n: int) -> list[Errand]:
    """The goals of `n` agents, drawn with repeats."""
    goals = list(maze.errands)
    drawn = stream(*maze.names, "errands").integers(0, len(goals), n)
    return [maze.errands[goals[i]] for i in drawn]


def goal_models_of(settings: Mapping, maze: Maze, experts: str) -> list[GoalModel]:
    """The goal models of experts of a kind, one for each goal."""
    if experts == "policies":
        return [GoalModel.from_best_actions(e.best, [e.goal], e.steps) for e in maze.errands.values()]
    n, models = settings["few_walks" if experts == "few walks" else "expert_walks"], []
    for goal, found in maze.errands.items():
        random = stream(*maze.names, "experts", experts, goal)
        others = np.array([other for other in maze.errands if other != goal])
        starts = others if experts == "trips" else found.tables.starts
        walks = [expert_walk(maze.world, found, int(start), random) for start in random.choice(starts, n)]
        models.append(GoalModel.from_trajectories(walks, maze.world.n_states, 4, [goal]))
    return models


def expert_walk(world: GridWorld, found: Errand, start: int, random: np.random.Generator) -> Trajectory:
    """A shortest path from `start`, drawn among equal moves step by step."""
    states, actions = [start], []
    while states[-1] != found.goal:
        ways = np.flatnonzero(found.best[states[-1]])
        actions.append(int(ways[0] if len(ways) == 1 else random.choice(ways)))
        states.append(int(world.neighbour[states[-1], actions[-1]]))
    return Trajectory(np.array(states), np.array(actions))


def thesis_advisor(
    settings: Mapping, purposes: Sequence[GoalModel], kappa: float | None = None, alpha0: float = 0.0
) -> Advisor:
    """M₁ pooled over all goals, M₂ uniform; `alpha0` is that of the advice."""
    kappa = settings["kappa"] if kappa is None else kappa
    pooled = replace(GoalModel.pooled(purposes), advised_alpha0=alpha0)
    return Advisor([pooled], None, AdviceSettings(kappa, settings["window"]))


def policy_of(world: GridWorld, agent: str, found: Errand) -> NDArray[np.float64]:
    """The action probabilities of one of `AGENTS` on an errand."""
    if agent == "optimal":
        chosen = found.best | ~found.best.any(axis=1, keepdims=True)
        return chosen / chosen.sum(axis=1, keepdims=True)
    world = replace(world, neighbour=found.moves)
    return explorer_probs(world, agent, found.goal if agent == "bug" else None)


def walk(
    maze: Maze,
    found: Errand,
    policy: NDArray[np.float64],
    advisor: Advisor,
    number: int,
    max_steps: int,
    heeds: bool = True,
) -> Walk:
    """An agent's walk on errand `number`; every agent meets the same start and random numbers."""
    random = stream(*maze.names, "walk", number)
    return advised_walk(found.tables, policy, advisor, random, max_steps, follows_advice=heeds)


def policies_of(settings: Mapping, maze: Maze, agent: str) -> list[NDArray[np.float64]]:
    """The action probabilities of one of `AGENTS` on each errand of a maze."""
    return [policy_of(maze.world, agent, found) for found in errands_of(maze, settings["tasks"])]


def walks_of(
    settings: Mapping,
    maze: Maze,
    policies: Sequence[NDArray[np.float64]],
    advisor: Advisor | Mapping[int, Advisor],
    heeds: bool = True,
) -> list[Walk]:
    """An agent's walks on all errands, with a policy for each; `advisor` is the same for all, or by goal."""
    walks = []
    for number, found in enumerate(errands_of(maze, settings["tasks"])):
        own = advisor[found.goal] if isinstance(advisor, Mapping) else advisor
        walks.append(walk(maze, found, policies[number], own, number, settings["max_steps"], heeds))
    return walks


def maze_estimate(values: ArrayLike) -> Estimate:
    """Mean over mazes; the interval of three or more equal values is the value itself."""
    values = np.round(np.asarray(values, float), ROUNDING)
    found = mean_estimate(values)
    if found.ci95 is None and len(values) >= 3:
        found = replace(found, ci95=(found.value, found.value))
    return found


def grid_share(answers: Sequence[bool]) -> Estimate:
    """Share of true answers among the cells of a grid."""
    return exact_value(float(np.mean(answers)), len(answers))
