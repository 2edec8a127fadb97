"""What is known of a world whose moves are certain: where moves lead, what places hold, and the way from there.

Transitions belong to the domain and may be remembered; what a place holds belongs to the task and never is.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.jit import kernel

UNKNOWN = -1
"""Target of a move never made, and percept of a state never seen."""
NOT_LOOKED, LOOKED, DEAD_END, GOAL = range(4)
"""What this task knows of a place: nothing, nothing there, the episode ends badly, the goal."""


class Model(NamedTuple):
    """Remembered knowledge of a domain; changed in place.

    target : (n_states, n_actions) int32, state that a move leads to, UNKNOWN where never made
    percept : (n_states,) int64, what was perceived there, UNKNOWN where never
    """

    target: NDArray[np.int32]
    percept: NDArray[np.int64]


def blank_model(n_states: int, n_actions: int) -> Model:
    """A model of a domain of which nothing is known."""
    return Model(np.full((n_states, n_actions), UNKNOWN, np.int32), np.full(n_states, UNKNOWN, np.int64))


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


def best_known_actions(model: Model, place: NDArray[np.int8]) -> NDArray[np.bool_]:
    """Which known moves shorten the way to the goal, (n_states, n_actions) bool; all ties count.

    Rows are all False where no way is known, and at the goal itself.
    """
    distance = goal_distances(model.target, place)
    known = model.target >= 0
    after = np.where(known, distance[model.target], -1)
    return known & (after >= 0) & (after == distance[:, None] - 1)


def known_policy(model: Model, place: NDArray[np.int8]) -> NDArray[np.int32]:
    """The greedy policy of what is known: (n_states,) first best move, -1 where no way is known."""
    best = best_known_actions(model, place)
    return np.where(best.any(axis=1), best.argmax(axis=1), -1).astype(np.int32)
