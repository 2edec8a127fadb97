"""`GoalModel`: the actions of experts on their way to one goal, and the steps that they still had to go.

Thesis: §3.7.1.3, offline phase. The thesis pools all goals into one prior (`GoalModel.pooled`).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.learning.known_world import GOAL, goal_distances


class Trajectory(NamedTuple):
    """States passed, (n + 1,) with the last one, and the action taken in each but the last, (n,).

    Examples
    --------
    >>> Trajectory(np.array([0, 1, 2]), np.array([1, 1])).actions.size
    2
    """

    states: NDArray[np.int64]
    actions: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class GoalModel:
    """Counts of the experts' actions on their way to a goal.

    Parameters
    ----------
    goals : tuple of int
        States of this goal; empty if goals are pooled.
    prior : ActionPrior
        Actions of the experts by state.
    steps : (n_states,) float64
        Mean number of steps that the experts still had to go, inf in states that no expert passed.
    advised_alpha0 : float
        α⁰ of the advice, in states that experts passed; above 0, actions that no expert took are advised at times.

    Examples
    --------
    >>> walk = Trajectory(np.array([0, 1, 2]), np.array([1, 1]))
    >>> model = GoalModel.from_trajectories([walk] * 5, 3, 2, goals=[2])
    >>> model.theta[0].round(2).tolist()
    [0.0, 1.0]
    """

    goals: tuple[int, ...]
    prior: ActionPrior
    steps: NDArray[np.float64]
    advised_alpha0: float = 0.0

    def __post_init__(self) -> None:
        if not self.advised_alpha0 >= 0:
            raise InputError(f"advised_alpha0 must be at least 0, got {self.advised_alpha0}")

    @property
    def theta(self) -> NDArray[np.float64]:
        """The advice, (n_states, n_actions): proportions of counts and ``advised_alpha0``; 0 without counts."""
        counts = self.prior.counts(np.arange(len(self.steps)))
        counts = np.where(counts.any(axis=1, keepdims=True), counts + self.advised_alpha0, counts)
        total = counts.sum(axis=1, keepdims=True)
        return np.divide(counts, total, out=np.zeros_like(counts), where=total > 0)

    @classmethod
    def from_trajectories(
        cls,
        trajectories: Iterable[Trajectory],
        n_states: int,
        n_actions: int,
        goals: Sequence[int] = (),
        alpha0: float = 0.1,
    ) -> "GoalModel":
        """Count every step; actions of -1 (without a known outcome) are skipped.

        Raises
        ------
        InputError
            A state or an action is out of range, or a trajectory's lengths do not fit.
        """
        prior = ActionPrior(n_actions, alpha0)
        to_go, visits = np.zeros(n_states), np.zeros(n_states)
        for trajectory in trajectories:
            states, actions = _checked(trajectory, n_states, n_actions)
            ahead = np.arange(len(actions), 0, -1)
            counted = actions >= 0
            prior.update_trajectory(states[:-1][counted], actions[counted])
            np.add.at(to_go, states[:-1][counted], ahead[counted])
            np.add.at(visits, states[:-1][counted], 1)
        steps = np.divide(to_go, visits, out=np.full(n_states, np.inf), where=visits > 0)
        return cls(tuple(int(goal) for goal in goals), prior, steps)

    @classmethod
    def pooled(cls, goal_models: Sequence["GoalModel"]) -> "GoalModel":
        """The thesis's model: one prior over all goals, without a goal of its own.

        Raises
        ------
        InputError
            The models differ in ``advised_alpha0``, or there is none.
        """
        advised = {model.advised_alpha0 for model in goal_models}
        if len(advised) != 1:
            raise InputError(f"goal_models must share advised_alpha0, got {sorted(advised)}")
        shown = np.any([np.isfinite(model.steps) for model in goal_models], axis=0)
        prior = ActionPrior.merged(model.prior for model in goal_models)
        return cls((), prior, np.where(shown, 0.0, np.inf), advised.pop())


def extend_goal_models(goal_models: Sequence[GoalModel], moves: ArrayLike) -> list[GoalModel]:
    """Extend each goal model to all states that experts of any goal passed.

    In a state that only experts of other goals passed, the best moves are those of the shortest path over states
    that experts passed (in either direction). States that no expert passed stay without advice.

    Parameters
    ----------
    goal_models : sequence of GoalModel
        Each with its goals.
    moves : (n_states, n_actions) int
        The map: the state to which each action leads, -1 where it is refused.
    """
    moves = np.asarray(moves, np.int32)
    passed = np.any([np.isfinite(model.steps) for model in goal_models], axis=0)
    passed[[goal for model in goal_models for goal in model.goals]] = True
    among = np.where((moves >= 0) & passed[:, None] & passed[moves], moves, -1).astype(np.int32)
    return [_extended(model, among) for model in goal_models]


def _extended(model: GoalModel, moves: NDArray[np.int32]) -> GoalModel:
    place = np.zeros(len(moves), np.int8)
    place[list(model.goals)] = GOAL
    distance = goal_distances(moves, place)
    new = ~np.isfinite(model.steps) & (distance > 0)
    nearer = (moves >= 0) & (distance[moves] == distance[:, None] - 1)
    prior = ActionPrior.merged([model.prior])
    prior.update(np.flatnonzero(new), nearer[new])
    return GoalModel(model.goals, prior, np.where(new, distance, model.steps))


def _checked(trajectory: Trajectory, n_states: int, n_actions: int):
    states, actions = np.asarray(trajectory.states, np.int64), np.asarray(trajectory.actions, np.int64)
    if len(states) != len(actions) + 1:
        raise InputError(
            f"a trajectory must have one state more than actions, its last state; "
            f"got {len(states)} states and {len(actions)} actions"
        )
    if states.min() < 0 or states.max() >= n_states:
        raise InputError(f"states must lie in [0, {n_states}), got {states.min()}..{states.max()}")
    if actions.size and (actions.min() < -1 or actions.max() >= n_actions):
        raise InputError(f"actions must lie in [0, {n_actions}) or be -1, got {actions.min()}..{actions.max()}")
    return states, actions
