"""Makes trajectories from experts' steps, goals from their ends, and a goal model for each goal."""

from collections import Counter
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.goal_model import GoalModel, Trajectory
from lifelore.agent.advise.step_lines import NO_ACTION, StepLine
from lifelore.core.errors import InputError
from lifelore.domains.grids.grid_world import MOVES, GridWorld

SAME_GOAL = 2
"""Maximum distance in moves at which two ends count as one goal."""


def state_after(world: GridWorld, step: StepLine) -> int:
    """The state after a step; the same state if the move is refused or there is no action."""
    target = -1 if step.action == NO_ACTION else int(world.neighbour[step.state, step.action])
    return step.state if target < 0 else target


def trajectories(steps: Iterable[StepLine], world: GridWorld) -> list[Trajectory]:
    """The trajectory of each unbroken walk of an agent.

    A walk ends at a step without action, or where the next step of the same agent begins in another state than the
    one that the step led to.
    """
    open_walks: dict[str | int, list[StepLine]] = {}
    found: list[Trajectory] = []
    for step in steps:
        walk = open_walks.setdefault(step.agent, [])
        if walk and state_after(world, walk[-1]) != step.state:
            found.append(_trajectory(walk, world))
            walk.clear()
        if step.action != NO_ACTION:
            walk.append(step)
        elif walk:
            found.append(_trajectory(walk, world))
            walk.clear()
    return found + [_trajectory(walk, world) for walk in open_walks.values() if walk]


def _trajectory(walk: Sequence[StepLine], world: GridWorld) -> Trajectory:
    states = [step.state for step in walk] + [state_after(world, walk[-1])]
    return Trajectory(np.array(states), np.array([step.action for step in walk]))


def goals_of_ends(walks: Sequence[Trajectory], world: GridWorld) -> list[int]:
    """States of the experts' goals: the most frequent end of each cluster of ends `SAME_GOAL` moves apart."""
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
    """Moves from a state to every state, (n_states,); `SAME_GOAL` + 1 for all that are farther."""
    moves = np.full(world.n_states, SAME_GOAL + 1, np.int64)
    moves[state] = 0
    for distance in range(1, SAME_GOAL + 1):
        reached = world.neighbour[moves == distance - 1]
        reached = reached[reached >= 0]
        moves[reached] = np.minimum(moves[reached], distance)
    return moves


def goal_models(walks: Sequence[Trajectory], goals: Sequence[int], world: GridWorld) -> list[GoalModel]:
    """A model of each goal, from the walks that ended near it; goals without a walk drop out.

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
            found.append(GoalModel.from_trajectories(own, world.n_states, len(MOVES), [goal]))
    if not found:
        raise InputError(
            f"experts must end at one of the {len(goals)} goals at least once, got none of {len(walks)}"
        )
    return found
