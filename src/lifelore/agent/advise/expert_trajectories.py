"""Experts' steps become trajectories, their ends goals, and both the ways an advisor knows."""

from collections import Counter
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.goal_model import Purpose, Trajectory
from lifelore.agent.advise.step_lines import NO_ACTION, StepLine
from lifelore.core.errors import InputError
from lifelore.domains.grids.grid_world import MOVES, GridWorld

SAME_GOAL = 2
"""Moves: ends so near to one another are one place."""


def after(world: GridWorld, step: StepLine) -> int:
    """Where a step leads: on, or nowhere if it is refused or none."""
    target = -1 if step.action == NO_ACTION else int(world.neighbour[step.state, step.action])
    return step.state if target < 0 else target


def trajectories(steps: Iterable[StepLine], world: GridWorld) -> list[Trajectory]:
    """One for each unbroken walk of an agent.

    A walk ends at a step without action, or where the next step of the same agent begins somewhere else than
    this one led.
    """
    under_way: dict[str | int, list[StepLine]] = {}
    found: list[Trajectory] = []
    for step in steps:
        walk = under_way.setdefault(step.agent, [])
        if walk and after(world, walk[-1]) != step.state:
            found.append(_trajectory(walk, world))
            walk.clear()
        if step.action != NO_ACTION:
            walk.append(step)
        elif walk:
            found.append(_trajectory(walk, world))
            walk.clear()
    return found + [_trajectory(walk, world) for walk in under_way.values() if walk]


def _trajectory(walk: Sequence[StepLine], world: GridWorld) -> Trajectory:
    states = [step.state for step in walk] + [after(world, walk[-1])]
    return Trajectory(np.array(states), np.array([step.action for step in walk]))


def goals_of_ends(walks: Sequence[Trajectory], world: GridWorld) -> list[int]:
    """Where experts went: the commonest end of each cluster of ends at most `SAME_GOAL` moves apart, by state."""
    count = Counter(int(walk.states[-1]) for walk in walks)
    left, goals = set(count), []
    while left:
        cluster, frontier = set(), [left.pop()]
        while frontier:
            end = frontier.pop()
            cluster.add(end)
            near = left & set(np.flatnonzero(_moves_from(world, end) <= SAME_GOAL).tolist())
            left -= near
            frontier += near
        goals.append(min(cluster, key=lambda state: (-count[state], state)))
    return sorted(goals)


def _moves_from(world: GridWorld, state: int) -> NDArray[np.int64]:
    """Moves from a state to each, counted up to `SAME_GOAL`; more where it is farther."""
    moves = np.full(world.n_states, SAME_GOAL + 1, np.int64)
    moves[state] = 0
    for distance in range(1, SAME_GOAL + 1):
        reached = world.neighbour[moves == distance - 1]
        reached = reached[reached >= 0]
        moves[reached] = np.minimum(moves[reached], distance)
    return moves


def purposes(walks: Sequence[Trajectory], goals: Sequence[int], world: GridWorld) -> list[Purpose]:
    """The ways to each goal: walks that ended at most `SAME_GOAL` moves from it; goals nobody went to fall out.

    Raises
    ------
    InputError
        No walk led to any of the goals.
    """
    found = []
    for goal in goals:
        moves = _moves_from(world, goal)
        own = [walk for walk in walks if moves[walk.states[-1]] <= SAME_GOAL]
        if own:
            found.append(Purpose.from_trajectories(own, world.n_states, len(MOVES), [goal]))
    if not found:
        raise InputError(
            f"experts must end at one of the {len(goals)} goals at least once, got none of {len(walks)}"
        )
    return found
