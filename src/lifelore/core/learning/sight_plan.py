"""Planned search by sight: a path to the place with the largest gain per step, or to the goal."""

import numpy as np

from lifelore.core.compiled.jit import kernel
from lifelore.core.compiled.random_state import uniform_integer
from lifelore.core.learning.known_world import DEAD_END, GOAL, NOT_LOOKED, UNKNOWN

SEARCH, DRIVE, SHORTEN = range(3)
"""Purposes of a plan: find the goal, reach the goal seen in this episode, or reach it on a shorter path."""


@kernel
def plan_by_sight(start, model, learner, gain, purpose):
    """Breadth-first search for the place to walk to; fills the learner's plan, returns its length or 0.

    That place is the goal if the purpose is DRIVE and a known path leads there; the goal or a place never seen,
    whichever is nearer, if it is SHORTEN; else the largest gain per step. A goal is also taken where no gain is
    left. `parent` must be UNKNOWN everywhere, and is so again afterwards.
    """
    target, remembered = model
    place, _, plan, queue, parent, parent_action, _, random, _, _, _, _, _ = learner
    best, best_score, ties = -1, 0.0, 0
    nearest, goal = -1, -1
    head, tail, level_end, depth = 0, 1, 1, 1.0
    queue[0] = start
    parent[start] = start
    while head < tail:
        if head == level_end:
            if nearest >= 0:
                break
            level_end, depth = tail, depth + 1.0
        s = queue[head]
        head += 1
        if s != start and (place[s] == GOAL or place[s] == DEAD_END):
            continue
        for a in range(target.shape[1]):
            t = target[s, a]
            if t == UNKNOWN or parent[t] != UNKNOWN:
                continue
            parent[t] = s
            parent_action[t] = a
            queue[tail] = t
            tail += 1
            if place[t] == GOAL:
                if goal < 0:
                    goal = t
                if purpose != SEARCH and (nearest < 0 or place[nearest] != GOAL):
                    nearest = t
            elif place[t] != DEAD_END:
                if purpose == SHORTEN and nearest < 0 and place[t] == NOT_LOOKED and remembered[t] == UNKNOWN:
                    nearest = t
                score = gain[t] / depth
                if score > best_score:
                    best, best_score, ties = t, score, 1
                elif score == best_score and score > 0.0:
                    ties += 1
                    if uniform_integer(random, ties) == 0:
                        best = t
    if nearest >= 0:
        best = nearest
    elif best < 0:
        best = goal
    length, s = 0, best
    if best >= 0:
        while s != start:
            plan[length] = parent_action[s]
            length += 1
            s = parent[s]
    for i in range(tail):
        parent[queue[i]] = UNKNOWN
    return np.int64(length)
