"""Knowledge of a deterministic world: known moves, percepts, and distances to the goal.

Transitions belong to the domain and may be remembered; goals and dead ends belong to the task and never are.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel

UNKNOWN = -1
"""Target of a move never made, and percept of a state never seen."""
END = -1
"""End of a list of moves."""
NOT_LOOKED, LOOKED, DEAD_END, GOAL = range(4)
"""Kinds of places in a task: not visited, plain, an end without reward, the goal."""


class WorldModel(NamedTuple):
    """Remembered knowledge of a domain; changed in place.

    target : (n_states, n_actions) int32, state that a move leads to, UNKNOWN where never made
    percept : (n_states,) int64, last percept of each state, UNKNOWN where never visited
    """

    target: NDArray[np.int32]
    percept: NDArray[np.int64]


def unknown_world(n_states: int, n_actions: int) -> WorldModel:
    """A model of a domain without any known move."""
    return WorldModel(np.full((n_states, n_actions), UNKNOWN, np.int32), np.full(n_states, UNKNOWN, np.int64))


@kernel
def goal_distances(target, place):
    """Steps to the goal over known moves, (n_states,) int32; 0 at the goal, -1 where no path is known."""
    n_states, n_actions = target.shape
    # The moves into each state as a linked list: its first move, and the move that follows each move.
    first, following = np.full(n_states, np.int32(END)), np.empty(n_states * n_actions, np.int32)
    for move in range(following.size):
        t = target[move // n_actions, move % n_actions]
        if t >= 0 and place[move // n_actions] != DEAD_END:
            following[move] = first[t]
            first[t] = move
    distance, queue = np.full(n_states, np.int32(-1)), np.empty(n_states, np.int32)
    head, tail = 0, 0
    for s in range(n_states):
        if place[s] == GOAL:
            distance[s] = 0
            queue[tail] = s
            tail += 1
    while head < tail:
        s = queue[head]
        head += 1
        move = first[s]
        while move != END:
            origin = move // n_actions
            if distance[origin] < 0:
                distance[origin] = distance[s] + 1
                queue[tail] = origin
                tail += 1
            move = following[move]
    return distance


def best_known_actions(model: WorldModel, place: NDArray[np.int8]) -> NDArray[np.bool_]:
    """Known moves that shorten the distance to the goal, (n_states, n_actions) bool; all ties count.

    Rows are all False where no path is known, and at the goal.
    """
    distance = goal_distances(model.target, place)
    known = model.target >= 0
    after = np.where(known, distance[model.target], -1)
    return known & (after >= 0) & (after == distance[:, None] - 1)


def known_policy(model: WorldModel, place: NDArray[np.int8]) -> NDArray[np.int32]:
    """The greedy policy of the known world: (n_states,) first best move, -1 where no path is known."""
    best = best_known_actions(model, place)
    return np.where(best.any(axis=1), best.argmax(axis=1), -1).astype(np.int32)
