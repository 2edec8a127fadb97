"""Model-based learning in deterministic worlds: learn transitions, plan the search on them.

Transitions belong to the domain and may be remembered from earlier tasks; the goal belongs to the task and never
is. Within a task every planned learner walks to the cheapest of

* a place not yet visited in this task, at the steps to it,
* a move not yet tried, at the steps to it and a cost of trying that the caller sets per context and action
  (an action prior makes unlikely moves dear: an order, never a mask),
* the goal, once seen, at the steps to it,

and so stays optimistic about unknown places. Memory is corrected: an observed transition overwrites a remembered
one, a state whose percept has changed is forgotten, and when no place is left to visit, remembered refusals are
forgotten.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.compiled.random_state import random_state, uniform_integer
from lifelore.core.errors import InputError
from lifelore.core.learning.curve import (
    DISCOUNT,
    EPISODE,
    GOALS,
    NEWS,
    PLAN_LENGTH,
    RETURN,
    STATE,
    STEP,
    TOTAL,
)
from lifelore.core.learning.known_world import DEAD_END, GOAL, LOOKED, NOT_LOOKED, UNKNOWN
from lifelore.core.learning.search_plan import OUT_OF_REACH, plan_search
from lifelore.core.mdp import COLLISION, TERMINAL, Tables

MOST_ACTIONS = np.iinfo(np.int8).max
"""Plans are stored as int8."""


class ExplorationStrategy(NamedTuple):
    """Search strategy of a learner.

    planned : plan the search; else always take the least-tried move of the current state
    exhaustive : prefer any reachable unknown to the goal (R-max's optimism)
    senses : a visit to a place reveals where all its moves lead (frontier search of robots)
    """

    planned: bool = True
    exhaustive: bool = False
    senses: bool = False


class StateInfo(NamedTuple):
    """Percept of each state, and the cost of trying an unknown move there.

    percept : (n_states,) int64
    cost_row : (n_states,) int32, row of `try_cost`
    try_cost : (n_contexts, n_actions) float64, in steps, at least 0
    """

    percept: NDArray[np.int64]
    cost_row: NDArray[np.int32]
    try_cost: NDArray[np.float64]


class ModelLearner(NamedTuple):
    """State of a model-based learner in one task, between calls of `explore`; changed in place.

    place : (n_states,) int8, NOT_LOOKED | LOOKED | DEAD_END | GOAL
    tried : (n_states, n_actions) int64, how often each move was made in this task
    plan : (n_states + 1,) int8, remaining actions, the next one last
    queue, parent : (n_states,) int32; parent_action : (n_states,) int8; work space of `plan_search`, where
        `parent` is UNKNOWN between calls
    world_random, own_random : (2,) uint64
    cursor : (7,) int64, see `curve.EPISODE` and the constants beside it; `KnownValue` sets news back
    running : (2,) float64, see `curve.RETURN`
    tour : (n_states,) int32, the order in which a tour visits places
    later : (n_states,) bool, whether a place is on the tour
    tour_at : (2,) int64, index of the tour's next place, and number of its places; 0 without a tour
    """

    place: NDArray[np.int8]
    tried: NDArray[np.int64]
    plan: NDArray[np.int8]
    queue: NDArray[np.int32]
    parent: NDArray[np.int32]
    parent_action: NDArray[np.int8]
    world_random: NDArray[np.uint64]
    own_random: NDArray[np.uint64]
    cursor: NDArray[np.int64]
    running: NDArray[np.float64]
    tour: NDArray[np.int32]
    later: NDArray[np.bool_]
    tour_at: NDArray[np.int64]


def new_model_learner(n_states: int, n_actions: int, world, own) -> ModelLearner:
    """A learner at the start of a task; `world` and `own` are numpy generators."""
    if not 1 <= n_actions <= MOST_ACTIONS:
        raise InputError(f"n_actions must lie in [1, {MOST_ACTIONS}], got {n_actions}: learn by Q-learning")

    return ModelLearner(
        np.zeros(n_states, np.int8),
        np.zeros((n_states, n_actions), np.int64),
        np.zeros(n_states + 1, np.int8),
        np.zeros(n_states, np.int32),
        np.full(n_states, UNKNOWN, np.int32),
        np.zeros(n_states, np.int8),
        random_state(world),
        random_state(own),
        np.array([0, 0, 0, 0, 0, 0, 1]),
        np.zeros(2),
        np.zeros(n_states, np.int32),
        np.zeros(n_states, np.bool_),
        np.zeros(2, np.int64),
    )


@kernel
def explore(tables, model, state_info, strategy, learner, curve, max_steps, discount, budget):
    """Run at most `budget` steps; returns how many were run, fewer once the last episode is over.

    The tables must be deterministic (one outcome). Episodes end at a terminal event or after `max_steps`.
    """
    next_state, reward_of, event_of, _, starts = tables
    target, seen = model
    planned, exhaustive, senses = strategy
    place, tried, plan, _, _, _, world, own, cursor, running, tour, later, tour_at = learner
    returns, rewards, steps, collisions, reached = curve
    n_actions = target.shape[1]
    episode, step = cursor[EPISODE], cursor[STEP]
    state, left = cursor[STATE], cursor[PLAN_LENGTH]
    goals = cursor[GOALS]
    ret, reach = running[RETURN], running[DISCOUNT]
    done_steps = 0
    while done_steps < budget and episode < returns.size:
        if step == 0:
            state = np.int64(starts[uniform_integer(world, starts.size)])
            left, ret, reach = 0, 0.0, 1.0
        if place[state] == NOT_LOOKED:
            place[state] = LOOKED
            if _arrive(state, target, seen, state_info.percept, tried):
                cursor[NEWS] = 1
            if senses:
                for move in range(n_actions):
                    target[state, move] = next_state[state, move, 0]
                left, cursor[NEWS] = 0, 1
        if planned:
            if left == 0:
                left = OUT_OF_REACH
            while left == OUT_OF_REACH:
                wanted = _next_on_tour(tour, tour_at, place) if goals == 0 else -1
                left = plan_search(state, target, state_info, learner, goals > 0, exhaustive, wanted)
                if left == OUT_OF_REACH:
                    later[wanted] = False
                    tour_at[0] += 1
            if left == 0:
                _doubt(target, tried)
                plan[0] = uniform_integer(own, n_actions)
                left = 1
            left -= 1
            a = np.int64(plan[left])
        else:
            a = least_tried(tried, state, own)
        following = np.int64(next_state[state, a, 0])
        reward = reward_of[state, a, 0]
        event = event_of[state, a, 0]
        tried[state, a] += 1
        if target[state, a] != following:
            target[state, a] = following
            left, cursor[NEWS] = 0, 1
        ret += reach * reward
        reach *= discount
        rewards[episode] += reward
        if event & COLLISION:
            collisions[episode] += 1
        if event & TERMINAL:
            found = GOAL if reward > 0 else DEAD_END
            if place[following] != found:
                if found == GOAL:
                    goals += 1
                elif place[following] == GOAL:
                    goals -= 1
                place[following], cursor[NEWS] = found, 1
        state = following
        step += 1
        done_steps += 1
        if event & TERMINAL or step >= max_steps:
            returns[episode] = ret
            steps[episode] = step
            reached[episode] = event & TERMINAL > 0 and reward > 0
            episode += 1
            step = 0
            left = 0
    cursor[EPISODE], cursor[STEP] = episode, step
    cursor[STATE], cursor[PLAN_LENGTH] = state, left
    cursor[TOTAL] += done_steps
    cursor[GOALS] = goals
    running[RETURN], running[DISCOUNT] = ret, reach
    return done_steps


@inlined
def _next_on_tour(tour, tour_at, place):
    """The next place of the tour that was not visited in this task; -1 if none is left."""
    while tour_at[0] < tour_at[1] and place[tour[tour_at[0]]] != NOT_LOOKED:
        tour_at[0] += 1
    return np.int64(tour[tour_at[0]]) if tour_at[0] < tour_at[1] else np.int64(-1)


@inlined
def _arrive(state, target, seen, percept, tried):
    """Forget the remembered moves of a place whose percept has changed; returns whether there were any."""
    forgot = False
    if seen[state] != percept[state]:
        for a in range(target.shape[1]):
            if tried[state, a] == 0:
                forgot |= target[state, a] != UNKNOWN
                target[state, a] = UNKNOWN
        seen[state] = percept[state]
    return forgot


@inlined
def least_tried(tried, state, random):
    """The move of a state that was made least often in this task; ties are drawn."""
    best, ties = 0, 0
    for a in range(tried.shape[1]):
        if tried[state, a] < tried[state, best]:
            best, ties = a, 1
        elif tried[state, a] == tried[state, best]:
            ties += 1
            if uniform_integer(random, ties) == 0:
                best = a
    return np.int64(best)


@kernel
def _doubt(target, tried):
    """Forget remembered refusals that this task has not met: they may be out of date."""
    for s in range(target.shape[0]):
        for a in range(target.shape[1]):
            if target[s, a] == s and tried[s, a] == 0:
                target[s, a] = UNKNOWN


def check_deterministic(tables: Tables) -> None:
    """Raise InputError unless each move has one outcome; this learner plans with no others."""
    if tables.n_outcomes != 1:
        raise InputError(
            f"tables must have one outcome a move to be planned with, got {tables.n_outcomes}: "
            "learn them by Q-learning"
        )
