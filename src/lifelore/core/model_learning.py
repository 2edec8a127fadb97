"""Model-based learning for worlds whose moves are certain: learn transitions, plan the search on them.

What belongs to the domain, the transitions T, may be remembered from earlier tasks; what belongs to the task,
where the goal lies, never is. Within a task every planned learner follows one rule: walk to the cheapest of

* a place not yet looked at in this task, at the steps to it,
* a move not yet tried, at the steps to it and a cost of trying that the caller sets per context and action
  (an action prior makes unlikely moves dear: an order, never a mask),
* the goal, once seen, at the steps to it,

and so stay optimistic about what is unknown. What was remembered is not believed blindly: a transition
observed otherwise is overwritten, a state whose percept has changed is forgotten, and when nothing is left to
look at, remembered refusals are doubted.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.jit import inlined, kernel
from lifelore.core.known_world import DEAD_END, GOAL, LOOKED, NOT_LOOKED, UNKNOWN
from lifelore.core.mdp import COLLISION, TERMINAL, Tables
from lifelore.core.random_state import one_of, random_state
from lifelore.core.search_plan import plan_search

MOST_ACTIONS = np.iinfo(np.int8).max
"""Plans are kept as int8."""


class Manner(NamedTuple):
    """How to look for the goal.

    planned : plan the search; else always the least-tried move of the state one is in
    exhaustive : while any unknown can be reached, prefer it to the goal (R-max's optimism)
    senses : a visit to a place reveals where all its moves lead (frontier search of robots)
    """

    planned: bool = True
    exhaustive: bool = False
    senses: bool = False


class Perceived(NamedTuple):
    """What a state shows, and what trying an unknown move there costs.

    percept : (n_states,) int64
    cost_row : (n_states,) int32, row of `try_cost`
    try_cost : (n_contexts, n_actions) float64, in steps, at least 0
    """

    percept: NDArray[np.int64]
    cost_row: NDArray[np.int32]
    try_cost: NDArray[np.float64]


class Explorer(NamedTuple):
    """Everything one task's learner carries between calls of `explore`; changed in place.

    place : (n_states,) int8, NOT_LOOKED | LOOKED | DEAD_END | GOAL
    tried : (n_states, n_actions) int64, how often each move was made in this task
    plan : (n_states + 1,) int8, actions still to do, the next one last
    queue, parent : (n_states,) int32; parent_action : (n_states,) int8; work space of `plan_search`
    world_random, own_random : (2,) uint64
    cursor : (5,) int64, episode, step in it, state, length of plan, total steps
    running : (2,) float64, return so far and the discount it has reached
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


def new_explorer(n_states: int, n_actions: int, world, own) -> Explorer:
    """A learner at the start of a task; `world` and `own` are numpy generators."""
    if not 1 <= n_actions <= MOST_ACTIONS:
        raise InputError(f"n_actions must lie in [1, {MOST_ACTIONS}], got {n_actions}: learn by Q-learning")

    return Explorer(
        np.zeros(n_states, np.int8),
        np.zeros((n_states, n_actions), np.int64),
        np.zeros(n_states + 1, np.int8),
        np.zeros(n_states, np.int32),
        np.zeros(n_states, np.int32),
        np.zeros(n_states, np.int8),
        random_state(world),
        random_state(own),
        np.zeros(5, np.int64),
        np.zeros(2),
    )


@kernel
def explore(tables, model, perceived, manner, explorer, curve, max_steps, discount, budget):
    """Run at most `budget` steps; returns how many were run, fewer once the last episode is over.

    The tables must be deterministic (one outcome). Episodes end at a terminal event or after `max_steps`.
    """
    next_state, reward_of, event_of, _, starts = tables
    target, seen = model
    percept, cost_row, try_cost = perceived
    planned, exhaustive, senses = manner
    place, tried, plan, queue, parent, parent_action, world, own, cursor, running = explorer
    returns, rewards, steps, collisions, reached = curve
    episode, step, state, left = cursor[0], cursor[1], cursor[2], cursor[3]
    ret, reach = running[0], running[1]
    done_steps = 0
    while done_steps < budget and episode < returns.size:
        if step == 0:
            state = np.int64(starts[one_of(world, starts.size)])
            left, ret, reach = np.int64(0), 0.0, 1.0
        if place[state] == NOT_LOOKED:
            place[state] = LOOKED
            _arrive(state, target, seen, percept, tried)
            if senses:
                for move in range(target.shape[1]):
                    target[state, move] = next_state[state, move, 0]
                left = np.int64(0)
        if planned:
            if left == 0:
                left = plan_search(
                    state, target, place, cost_row, try_cost, exhaustive, plan, queue, parent, parent_action, own
                )
            if left == 0:
                _doubt(target, tried)
                plan[0] = one_of(own, target.shape[1])
                left = np.int64(1)
            left -= 1
            a = np.int64(plan[left])
        else:
            a = _least_tried(tried, state, own)
        following = np.int64(next_state[state, a, 0])
        reward = reward_of[state, a, 0]
        event = event_of[state, a, 0]
        tried[state, a] += 1
        if target[state, a] != following:
            target[state, a] = following
            left = np.int64(0)
        ret += reach * reward
        reach *= discount
        rewards[episode] += reward
        if event & COLLISION:
            collisions[episode] += 1
        if event & TERMINAL:
            place[following] = GOAL if reward > 0 else DEAD_END
        state = following
        step += 1
        done_steps += 1
        if event & TERMINAL or step >= max_steps:
            returns[episode] = ret
            steps[episode] = step
            reached[episode] = event & TERMINAL > 0 and reward > 0
            episode += 1
            step = 0
            left = np.int64(0)
    cursor[0], cursor[1], cursor[2], cursor[3] = episode, step, state, left
    cursor[4] += done_steps
    running[0], running[1] = ret, reach
    return done_steps


@inlined
def _arrive(state, target, seen, percept, tried):
    """The percept changed since it was remembered: forget what was remembered of this place."""
    if seen[state] != percept[state]:
        for a in range(target.shape[1]):
            if tried[state, a] == 0:
                target[state, a] = UNKNOWN
        seen[state] = percept[state]


@inlined
def _least_tried(tried, state, random):
    best, ties = 0, 0
    for a in range(tried.shape[1]):
        if tried[state, a] < tried[state, best]:
            best, ties = a, 1
        elif tried[state, a] == tried[state, best]:
            ties += 1
            if one_of(random, ties) == 0:
                best = a
    return np.int64(best)


@kernel
def _doubt(target, tried):
    """Nothing is left to look at: remembered refusals that this task has not met may be out of date."""
    for s in range(target.shape[0]):
        for a in range(target.shape[1]):
            if target[s, a] == s and tried[s, a] == 0:
                target[s, a] = UNKNOWN


def check_deterministic(tables: Tables) -> None:
    """Raise unless each move has one outcome, which is what this learner can plan with."""
    if tables.outcome_cum.size != 1:
        raise InputError(
            f"tables must have one outcome a move to be planned with, got {tables.outcome_cum.size}: "
            "learn them by Q-learning"
        )
