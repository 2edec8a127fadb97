"""Mazes, experts and errands of the claims on advice, and who watches: what C3.15 to C3.18 share.

The thesis draws one maze and does not say how its experts walked. Here loop densities are crossed with kinds of
experts, over many mazes: an interval is over mazes, since the errands of one maze share its experts. Experts go
shortest ways, as policies learnt to the end do. Everything compared in an errand shares its start and its random
numbers. Thesis: §3.7.2.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.advised_walk import Walk, advised_walk
from lifelore.action.advice.advisor import BETTER, AdviceSettings, Advisor
from lifelore.action.advice.behaviour_models import Tabulated
from lifelore.action.advice.goal_model import GoalModel, Trajectory, extend_goal_models
from lifelore.core.learning.known_world import GOAL, goal_distances
from lifelore.core.mdp import Tables
from lifelore.core.streams import stream
from lifelore.domains.advice.advice_maze import advice_maze, errand, maze_goals
from lifelore.domains.advice.explorers import EXPLORERS, explorer_probs
from lifelore.domains.grids.grid_world import GridWorld

EXPERTS = ("walks", "few walks", "trips", "policies")
"""Walks to each goal from anywhere, few of them, walks from other goals; or what is best in every state."""
AGENTS = (*EXPLORERS, "optimal")
GRID = {
    "size": 30,
    "loops": [0.0, 0.1, 0.2, 0.4],
    "experts": list(EXPERTS),
    "expert_walks": 20,
    "few_walks": 5,
    "kappa": 0.5,
    "window": 300,
    "default": {"loops": 0.1, "experts": "walks"},
}
"""The settings that the claims share at full size."""
SMALL = {**GRID, "size": 13, "loops": [0.1], "experts": ["walks", "policies"], "expert_walks": 4}


class Errand(NamedTuple):
    """One task of the maze: its goal, tables, the best moves of every state, and the steps left from there.

    best : (n_states, 4) bool, none at the goal
    steps : (n_states,) float64
    """

    goal: int
    tables: Tables
    best: NDArray[np.bool_]
    steps: NDArray[np.float64]


class Maze(NamedTuple):
    """A maze, the errand to each of its goals, and the names of its streams."""

    world: GridWorld
    errands: dict[int, Errand]
    names: tuple


def maze_cells(settings: Mapping) -> list[dict]:
    """A cell for each maze of each loop density."""
    return [{"loops": loops, "maze": number} for loops in settings["loops"] for number in range(settings["mazes"])]


def maze_of(settings: Mapping, cell: Mapping, seed: int) -> Maze:
    """The maze of a cell."""
    names = (seed, "advice", f"{cell['loops']:g}", cell["maze"])
    world = advice_maze(stream(*names, "maze"), settings["size"], cell["loops"])
    return Maze(world, {int(goal): errand_to(world, int(goal)) for goal in maze_goals(world)}, names)


def errand_to(world: GridWorld, goal: int) -> Errand:
    """The errand to a goal; where several moves are as good, all are best."""
    place = np.zeros(world.n_states, np.int8)
    place[goal] = GOAL
    moves = world.neighbour
    steps = goal_distances(moves, place).astype(float)
    best = (moves >= 0) & (steps[moves] == steps[:, None] - 1)
    return Errand(goal, errand(world, goal).tables(), best, steps)


def errands_of(maze: Maze, n: int) -> list[Errand]:
    """The goals of `n` agents, drawn with repeats."""
    goals = list(maze.errands)
    drawn = stream(*maze.names, "errands").integers(0, len(goals), n)
    return [maze.errands[goals[i]] for i in drawn]


def purposes_of(settings: Mapping, maze: Maze, experts: str) -> list[GoalModel]:
    """What experts of a kind, bound for each goal in turn, left behind."""
    return [_purpose(settings, maze, goal, experts) for goal in maze.errands]


def _purpose(settings: Mapping, maze: Maze, goal: int, experts: str) -> GoalModel:
    found = maze.errands[goal]
    if experts == "policies":
        return GoalModel.from_best_actions(found.best, [goal], found.steps)
    random = stream(*maze.names, "experts", experts, goal)
    others = np.array([g for g in maze.errands if g != goal])
    starts = others if experts == "trips" else found.tables.starts
    n = settings["few_walks" if experts == "few walks" else "expert_walks"]
    walks = [expert_walk(maze.world, found, int(start), random) for start in random.choice(starts, n)]
    return GoalModel.from_trajectories(walks, maze.world.n_states, 4, [goal])


def expert_walk(world: GridWorld, found: Errand, start: int, random: np.random.Generator) -> Trajectory:
    """A shortest way from `start`, drawn among equals step by step."""
    states, actions = [start], []
    while states[-1] != found.goal:
        ways = np.flatnonzero(found.best[states[-1]])
        actions.append(int(ways[0] if len(ways) == 1 else random.choice(ways)))
        states.append(int(world.neighbour[states[-1], actions[-1]]))
    return Trajectory(np.array(states), np.array(actions))


def thesis_advisor(settings: Mapping, purposes: Sequence[GoalModel], kappa: float | None = None) -> Advisor:
    """M₁ pooled over all goals, M₂ uniform."""
    kappa = settings["kappa"] if kappa is None else kappa
    return Advisor.of_thesis(purposes, AdviceSettings(kappa, settings["window"]))


def better_advisor(
    settings: Mapping, world: GridWorld, purposes: Sequence[GoalModel], explorers: bool = True
) -> Advisor:
    """Goals apart, at most 40 steps in 100 advised; `explorers`: whether it knows how each of them walks."""
    chosen = replace(BETTER, kappa=settings["kappa"], window=settings["window"])
    others = None
    if explorers:
        bugs = [Tabulated(explorer_probs(world, "bug", purpose.goals[0])) for purpose in purposes]
        others = [*(Tabulated(explorer_probs(world, name)) for name in EXPLORERS if name != "bug"), bugs]
    return Advisor(extend_goal_models(purposes, world.neighbour), others, chosen)


def policy_of(world: GridWorld, agent: str, found: Errand) -> NDArray[np.float64]:
    """The action probabilities of one of `AGENTS` on an errand."""
    if agent == "optimal":
        chosen = found.best | ~found.best.any(axis=1, keepdims=True)
        return chosen / chosen.sum(axis=1, keepdims=True)
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
    """An agent's walk on the maze's errand `number`: the same start and random numbers whoever walks."""
    random = stream(*maze.names, "walk", number)
    return advised_walk(found.tables, policy, advisor, random, max_steps, follows_advice=heeds)
