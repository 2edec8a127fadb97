"""Search by sight: a learner that perceives places at a distance walks to the views with most new places a step.

In each state the learner perceives all states in sight: where their moves lead, and whether they are the goal.
It walks to the place with the largest ratio of new places in sight to steps (frontier-based exploration,
Yamauchi 1997, with the gain of the next best view). In a remembered world all places are known, and the same rule
is a greedy tour of viewpoints. For two known places, the learner knows whether they are in sight of each other.

Once the goal is seen, the learner walks to it. In later episodes of the task it first looks into places never seen
that are nearer than the goal, as they may hide a shorter path.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.compiled.random_state import uniform_integer
from lifelore.core.learning.curve import DISCOUNT, EPISODE, GOALS, NEWS, PLAN_LENGTH, RETURN, STATE, STEP, TOTAL
from lifelore.core.learning.known_world import DEAD_END, GOAL, LOOKED, NOT_LOOKED, UNKNOWN, WorldModel
from lifelore.core.learning.model_learning import least_tried
from lifelore.core.learning.sight_plan import DRIVE, SEARCH, SHORTEN, plan_by_sight
from lifelore.core.mdp import COLLISION, TERMINAL, Tables

FOUND_STEP, FOUND_EPISODE = 0, 1
"""Places in `SightSearch.found`."""


class SightSearch(NamedTuple):
    """Sight of a world, and the state of a search by sight in one task; the last four are changed in place.

    begin, seen : (n_states + 1,) int64 and (n_pairs,) int32: ``seen[begin[s]:begin[s + 1]]`` are the states in
        sight of s, with s itself and all states that its moves lead to; sight is mutual
    revealed : (n_states,) int8, LOOKED | DEAD_END | GOAL, which the learner recognises on sight
    new : (n_states,) int8, 1 for places that are known, as remembered or as the end of a known move, but not yet
        seen in this task
    gain : (n_states,) int32, number of new places in sight
    stood : (n_states,) int8, 1 for states in which the learner has been in this task
    found : (2,) int64, steps of the task and episode at which the goal was first seen; -1 before
    """

    begin: NDArray[np.int64]
    seen: NDArray[np.int32]
    revealed: NDArray[np.int8]
    new: NDArray[np.int8]
    gain: NDArray[np.int32]
    stood: NDArray[np.int8]
    found: NDArray[np.int64]


def new_sight_search(
    begin: NDArray[np.int64], seen: NDArray[np.int32], tables: Tables, model: WorldModel
) -> SightSearch:
    """The search at the start of a task, for a learner that remembers `model`; arrays as in `SightSearch`."""
    new = (model.percept != UNKNOWN).astype(np.int8)
    new[model.target[model.target != UNKNOWN]] = 1
    sums = np.concatenate([[0], np.cumsum(new[seen], dtype=np.int64)])
    return SightSearch(
        begin,
        seen,
        places_on_sight(tables),
        new,
        (sums[begin[1:]] - sums[begin[:-1]]).astype(np.int32),
        np.zeros(tables.n_states, np.int8),
        np.full(2, -1),
    )


def places_on_sight(tables: Tables) -> NDArray[np.int8]:
    """The kind of each place, (n_states,) int8: GOAL if moves into it end the episode with reward; else DEAD_END
    if they end it, LOOKED if they do not."""
    kind = np.full(tables.n_states, LOOKED, np.int8)
    ends = tables.event[:, :, 0] & TERMINAL > 0
    kind[tables.next_state[:, :, 0][ends]] = DEAD_END
    kind[tables.next_state[:, :, 0][ends & (tables.reward[:, :, 0] > 0)]] = GOAL
    return kind


@kernel
def explore_by_sight(tables, model, state_info, strategy, learner, search, curve, max_steps, discount, budget):
    """Run at most `budget` steps; returns how many were run, fewer once the last episode is over.

    The arguments are those of `explore` and a `SightSearch`.
    """
    next_state, reward_of, event_of, _, starts = tables
    planned, exhaustive, _ = strategy
    place, tried, plan, queue, _, _, world, own, cursor, running, _, _, _ = learner
    returns, rewards, steps, collisions, reached = curve
    stood, found = search.stood, search.found
    episode, step = cursor[EPISODE], cursor[STEP]
    state, left = cursor[STATE], cursor[PLAN_LENGTH]
    goals = cursor[GOALS]
    ret, reach = running[RETURN], running[DISCOUNT]
    done_steps = 0
    while done_steps < budget and episode < returns.size:
        if step == 0:
            state = np.int64(starts[uniform_integer(world, starts.size)])
            left, ret, reach = 0, 0.0, 1.0
        if stood[state] == 0:
            stood[state] = 1
            n_new, new_goals = _look(state, next_state, model, state_info.percept, place, queue, search)
            if n_new > 0:
                left, cursor[NEWS] = 0, 1
            if new_goals > 0:
                goals += new_goals
                if found[FOUND_STEP] < 0:
                    found[FOUND_STEP], found[FOUND_EPISODE] = cursor[TOTAL] + done_steps, episode
        if planned:
            if left == 0:
                purpose = SEARCH
                if goals > 0 and not exhaustive:
                    purpose = DRIVE if episode == found[FOUND_EPISODE] else SHORTEN
                left = plan_by_sight(state, model, learner, search.gain, purpose)
            if left == 0:
                plan[0] = uniform_integer(own, tried.shape[1])
                left = 1
            left -= 1
            a = np.int64(plan[left])
        else:
            a = least_tried(tried, state, own)
        following = np.int64(next_state[state, a, 0])
        reward = reward_of[state, a, 0]
        event = event_of[state, a, 0]
        tried[state, a] += 1
        ret += reach * reward
        reach *= discount
        rewards[episode] += reward
        if event & COLLISION:
            collisions[episode] += 1
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


@kernel
def _look(state, next_state, model, percept, place, queue, search):
    """Learn the moves of all places in sight; returns how many are new in this task, and how many are goals."""
    target, remembered = model
    begin, seen, revealed, new, gain, _, _ = search
    n_new, goals = 0, 0
    for k in range(begin[state], begin[state + 1]):
        s = seen[k]
        if place[s] == NOT_LOOKED:
            place[s] = revealed[s]
            if revealed[s] == GOAL:
                goals += 1
            remembered[s] = percept[s]
            for a in range(target.shape[1]):
                target[s, a] = next_state[s, a, 0]
            if new[s] == 1:
                _count(s, new, -1, begin, seen, gain)
            queue[n_new] = s
            n_new += 1
    for k in range(n_new):
        s = queue[k]
        for a in range(target.shape[1]):
            t = target[s, a]
            if place[t] == NOT_LOOKED and new[t] == 0:
                _count(t, new, 1, begin, seen, gain)
    return n_new, goals


@inlined
def _count(state, new, change, begin, seen, gain):
    """Add a place to the new ones (`change` 1) or remove it (-1)."""
    new[state] += change
    for k in range(begin[state], begin[state + 1]):
        gain[seen[k]] += change
