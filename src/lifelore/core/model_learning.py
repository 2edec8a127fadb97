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
from lifelore.core.mdp import COLLISION, TERMINAL, Tables
from lifelore.core.random_state import next_uniform, random_state

UNKNOWN = -1
"""Target of a move never made, and percept of a state never seen."""
NOT_LOOKED, LOOKED, DEAD_END, GOAL = range(4)
"""What this task knows of a place: nothing, nothing there, the episode ends badly, the goal."""


NO_CRUMBS = 0.2
"""Among places equally near, first those with fewest others not looked at beside them (Warnsdorff's rule).
Measured on three buildings: the mean search falls from 0.67 to 0.59 of the number of places, where 0.5 is the
least any searcher can need that must enter a place to see whether the goal is there. At most 1 / (moves + 1), so
that a nearer place always comes first: with more than four moves a crumb weighs less."""
MOST_ACTIONS = np.iinfo(np.int8).max
"""Plans are kept as int8."""


class Model(NamedTuple):
    """Remembered knowledge of a domain; changed in place.

    target : (n_states, n_actions) int32, state that a move leads to, UNKNOWN where never made
    percept : (n_states,) int64, what was perceived there, UNKNOWN where never
    """

    target: NDArray[np.int32]
    percept: NDArray[np.int64]


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
    queue, parent : (n_states,) int32; parent_action : (n_states,) int8; the planner's desk
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


def blank_model(n_states: int, n_actions: int) -> Model:
    """A model of a domain of which nothing is known."""
    return Model(np.full((n_states, n_actions), UNKNOWN, np.int32), np.full(n_states, UNKNOWN, np.int64))


def new_explorer(n_states: int, n_actions: int, world, own) -> Explorer:
    """A learner at the start of a task; `world` and `own` are numpy generators."""
    if not 1 <= n_actions <= MOST_ACTIONS:
        raise InputError(f"learner 'model' takes 1 to {MOST_ACTIONS} actions, got {n_actions}: use learner 'q'")
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
            state = np.int64(starts[_one_of(world, starts.size)])
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
                left = _plan(
                    state, target, place, cost_row, try_cost, exhaustive, plan, queue, parent, parent_action, own
                )
            if left == 0:
                _doubt(target, tried)
                plan[0] = _one_of(own, target.shape[1])
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


@kernel
def _one_of(random, n):
    """One of 0 … n - 1, each as likely."""
    return np.int64(next_uniform(random) * n)


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
            if _one_of(random, ties) == 0:
                best = a
    return np.int64(best)


@kernel
def _doubt(target, tried):
    """Nothing is left to look at: remembered refusals that this task has not met may be out of date."""
    for s in range(target.shape[0]):
        for a in range(target.shape[1]):
            if target[s, a] == s and tried[s, a] == 0:
                target[s, a] = UNKNOWN


@inlined
def _not_looked_around(s, target, place):
    count = 0
    for a in range(target.shape[1]):
        t = target[s, a]
        if t >= 0 and t != s and place[t] == NOT_LOOKED:
            count += 1
    return count


@kernel
def _plan(start, target, place, cost_row, try_cost, exhaustive, plan, queue, parent, parent_action, random):
    """Breadth-first search for the cheapest thing to do next; fills `plan`, returns its length or 0."""
    goal_known = False
    for s in range(place.size):
        parent[s] = UNKNOWN
        goal_known |= place[s] == GOAL
    crumb = min(NO_CRUMBS, 1.0 / (target.shape[1] + 1))
    best_cost, best_state, best_action, ties = np.inf, -1, 0, 0
    goal_state, goal_action = -1, 0
    head, tail = 0, 1
    queue[0] = start
    parent[start] = start
    level_end, depth = 1, 1.0
    while head < tail and depth <= best_cost:
        s = queue[head]
        head += 1
        for a in range(target.shape[1]):
            t = target[s, a]
            cost = np.inf
            if t == UNKNOWN:
                cost = depth + try_cost[cost_row[s], a]
            elif place[t] == GOAL:
                if exhaustive:
                    if goal_state < 0:
                        goal_state, goal_action = s, a
                else:
                    cost = depth
            elif place[t] == NOT_LOOKED and not goal_known:
                cost = depth + crumb * _not_looked_around(t, target, place)
            elif place[t] != DEAD_END and parent[t] == UNKNOWN:
                parent[t] = s
                parent_action[t] = a
                queue[tail] = t
                tail += 1
            if cost < best_cost:
                best_cost, best_state, best_action, ties = cost, s, a, 1
            elif cost == best_cost and cost < np.inf:
                ties += 1
                if _one_of(random, ties) == 0:
                    best_state, best_action = s, a
        if head == level_end:
            level_end = tail
            depth += 1.0
    if best_state < 0:
        best_state, best_action = goal_state, goal_action
    if best_state < 0:
        return np.int64(0)
    plan[0] = best_action
    length, s = 1, best_state
    while s != start:
        plan[length] = parent_action[s]
        length += 1
        s = parent[s]
    return np.int64(length)


@kernel
def goal_distances(target, place):
    """Steps to the goal over known moves, (n_states,) int32; 0 at the goal, -1 where no way is known."""
    n_states, n_actions = target.shape
    # Who leads where: the moves into each state, as a linked list.
    last_into = np.full(n_states, -1, np.int32)
    before = np.empty(n_states * n_actions, np.int32)
    for s in range(n_states):
        for a in range(n_actions):
            t = target[s, a]
            if t >= 0:
                before[s * n_actions + a] = last_into[t]
                last_into[t] = s * n_actions + a
    distance = np.full(n_states, -1, np.int32)
    queue = np.empty(n_states, np.int32)
    tail = 0
    for s in range(n_states):
        if place[s] == GOAL:
            distance[s] = 0
            queue[tail] = s
            tail += 1
    head = 0
    while head < tail:
        s = queue[head]
        head += 1
        move = last_into[s]
        while move >= 0:
            origin = move // n_actions
            if distance[origin] < 0 and place[origin] != DEAD_END:
                distance[origin] = distance[s] + 1
                queue[tail] = origin
                tail += 1
            move = before[move]
    return distance


def best_known_actions(model: Model, explorer: Explorer) -> NDArray[np.bool_]:
    """Which known moves shorten the way to the goal, (n_states, n_actions) bool; all ties count.

    Rows are all False where no way is known, and at the goal itself.
    """
    distance = goal_distances(model.target, explorer.place)
    known = model.target >= 0
    after = np.where(known, distance[model.target], -1)
    return known & (after >= 0) & (after == distance[:, None] - 1)


def known_policy(model: Model, explorer: Explorer) -> NDArray[np.int32]:
    """The greedy policy of what is known: (n_states,) first best move, -1 where no way is known."""
    best = best_known_actions(model, explorer)
    return np.where(best.any(axis=1), best.argmax(axis=1), -1).astype(np.int32)


def check_deterministic(tables: Tables) -> None:
    """Raise unless each move has one outcome, which is what this learner can plan with."""
    if tables.outcome_cum.size != 1:
        raise InputError(
            f"learner 'model' needs moves with one outcome, this world has {tables.outcome_cum.size}: "
            "use learner 'q'"
        )
