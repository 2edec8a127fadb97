"""What is known of a world whose moves are certain: where moves lead, what places hold, and the way from there.

Transitions belong to the domain and may be remembered; what a place holds belongs to the task and never is.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel

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


class WaysIn(NamedTuple):
    """The known moves into each state as linked lists, and steps to the goal over them; changed in place.

    distance : (n_states,) int32, steps to the goal; 0 at the goal, -1 where no way is known
    last_into : (n_states,) int32, the first move of the list into each state, END where there is none
    before : (n_states · n_actions,) int32, the move that follows a move in its list, END, or NOT_LISTED
    queue : (n_states,) int32, work space
    starts : (n_states,) int32, how often each state is among the starts that are counted
    starts_at : (n_states + 1,) int64, starts at each distance to the goal
    farthest : (1,) int64, no start was ever farther from the goal than this

    A move is numbered state · n_actions + action. Moves that stay where they are, are in no list.
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


def blank_ways(n_states: int, n_actions: int, starts: NDArray[np.int32] | None = None) -> WaysIn:
    """Lists without a move. `starts`: (n_starts,) states whose distances are counted."""
    counted = np.zeros(n_states, np.int32)
    if starts is not None:
        np.add.at(counted, starts, 1)
    return WaysIn(
        np.full(n_states, -1, np.int32),
        np.full(n_states, END, np.int32),
        np.full(n_states * n_actions, NOT_LISTED, np.int32),
        np.empty(n_states, np.int32),
        counted,
        np.zeros(n_states + 1, np.int64),
        np.zeros(1, np.int64),
    )


def find_ways(target: NDArray[np.int32], place: NDArray[np.int8], ways: WaysIn) -> None:
    """List every known move anew and find all distances."""
    ways.distance[:], ways.last_into[:], ways.before[:] = -1, END, NOT_LISTED
    ways.starts_at[:], ways.farthest[:] = 0, 0
    goals = np.flatnonzero(place == GOAL)
    ways.distance[goals] = 0
    _list_and_spread(target, place, np.arange(target.size), goals, ways)


def add_moves(target: NDArray[np.int32], place: NDArray[np.int8], moves: NDArray[np.int64], ways: WaysIn) -> None:
    """List these moves too and shorten the distances that they shorten."""
    _list_and_spread(target, place, moves, _NONE, ways)


@kernel(allocates=False)
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
                # All moves cost one step, so the first time a state is reached is the nearest.
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
    """Steps to the goal over known moves, (n_states,) int32; 0 at the goal, -1 where no way is known."""
    ways = blank_ways(*target.shape)
    find_ways(target, place, ways)
    return ways.distance


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
