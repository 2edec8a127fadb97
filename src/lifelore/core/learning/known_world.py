"""Knowledge of a deterministic world: known moves, percepts, and distances to the goal.

Transitions belong to the domain and may be remembered; goals and dead ends belong to the task and never are.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel

UNKNOWN = -1
"""Target of a move never made, and percept of a state never seen."""
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


class IncomingMoves(NamedTuple):
    """The known moves into each state as linked lists, and steps to the goal over them; changed in place.

    distance : (n_states,) int32, steps to the goal; 0 at the goal, -1 where no path is known
    last_into : (n_states,) int32, the first move of the list into each state, END where there is none
    before : (n_states · n_actions,) int32, the move that follows a move in its list, END, or NOT_LISTED
    queue : (n_states,) int32, work space
    starts : (n_states,) int32, number of counted starts in each state
    starts_at : (n_states + 1,) int64, starts at each distance to the goal
    farthest : (1,) int64, largest distance of any start so far

    A move is numbered state · n_actions + action. Moves that do not leave their state are in no list.
    """

    distance: NDArray[np.int32]
    last_into: NDArray[np.int32]
    before: NDArray[np.int32]
    queue: NDArray[np.int32]
    starts: NDArray[np.int32]
    starts_at: NDArray[np.int64]
    farthest: NDArray[np.int64]


END, NOT_LISTED = -1, -2
_NONE = np.empty(0, np.int64)


def no_incoming_moves(n_states: int, n_actions: int, starts: NDArray[np.int32] | None = None) -> IncomingMoves:
    """Empty lists. `starts`: (n_starts,) states whose distances are counted."""
    counted = np.zeros(n_states, np.int32)
    if starts is not None:
        np.add.at(counted, starts, 1)
    return IncomingMoves(
        np.full(n_states, -1, np.int32),
        np.full(n_states, END, np.int32),
        np.full(n_states * n_actions, NOT_LISTED, np.int32),
        np.empty(n_states, np.int32),
        counted,
        np.zeros(n_states + 1, np.int64),
        np.zeros(1, np.int64),
    )


def find_goal_distances(target: NDArray[np.int32], place: NDArray[np.int8], ways: IncomingMoves) -> None:
    """Rebuild the lists from all known moves and compute all distances."""
    ways.distance[:], ways.last_into[:], ways.before[:] = -1, END, NOT_LISTED
    ways.starts_at[:], ways.farthest[:] = 0, 0
    goals = np.flatnonzero(place == GOAL)
    ways.distance[goals] = 0
    _list_and_spread(target, place, np.arange(target.size), goals, ways)


def add_moves(
    target: NDArray[np.int32], place: NDArray[np.int8], moves: NDArray[np.int64], ways: IncomingMoves
) -> None:
    """Add moves to the lists and update the distances that become shorter."""
    _list_and_spread(target, place, moves, _NONE, ways)


@kernel
def _list_and_spread(target, place, moves, goals, ways):
    """List moves; then breadth first from all `goals` together or, without goals, from where each move leads.

    One kernel, because each costs a quarter of a second to compile.
    """
    distance, last_into, before, queue, starts, starts_at, farthest = ways
    n_actions = target.shape[1]
    for i in range(moves.size):
        move = moves[i]
        t = target[move // n_actions, move % n_actions]
        if t >= 0 and t != move // n_actions and before[move] == NOT_LISTED:
            before[move] = last_into[t]
            last_into[t] = move
    rounds = moves.size if goals.size == 0 else 1
    for i in range(rounds):
        tail = goals.size
        for k in range(goals.size):
            queue[k] = goals[k]
        if goals.size == 0:
            t = target[moves[i] // n_actions, moves[i] % n_actions]
            if t >= 0 and distance[t] >= 0:
                queue[0] = t
                tail = 1
        head = 0
        while head < tail:
            s = queue[head]
            steps = distance[s] + 1
            head += 1
            move = last_into[s]
            while move != END:
                origin = move // n_actions
                move = before[move]
                # All moves cost one step, so a state is first reached at its smallest distance.
                if place[origin] != DEAD_END and (distance[origin] < 0 or distance[origin] > steps):
                    if distance[origin] >= 0:
                        starts_at[distance[origin]] -= starts[origin]
                    distance[origin] = steps
                    starts_at[steps] += starts[origin]
                    if steps > farthest[0]:
                        farthest[0] = steps
                    queue[tail] = origin
                    tail += 1


def goal_distances(target: NDArray[np.int32], place: NDArray[np.int8]) -> NDArray[np.int32]:
    """Steps to the goal over known moves, (n_states,) int32; 0 at the goal, -1 where no path is known."""
    ways = no_incoming_moves(*target.shape)
    find_goal_distances(target, place, ways)
    return ways.distance


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
