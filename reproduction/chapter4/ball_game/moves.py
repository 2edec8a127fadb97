"""Evidence that one move of the ball gives about its size, to an observer of the field.

A signal is the observed (s, a, s') in coarse form, one number: how much room there was where the ball stood and
along the way that was commanded (the context), what became of the command, and how much room there is where the
ball is now (the outcome). Room is the distance to the nearest obstacle, in classes; nothing here depends on the
type. Thesis: §4.8.4.1, §4.8.5.1.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.domains.ball_game.ball_game import MOVES
from lifelore.interaction.signals.category_signal import CategorySignal

BEFORE_EDGES = np.array([2.0, 4.0, 8.0, 16.0, 32.0, 64.0])
AFTER_EDGES = np.array([2.0, 4.0, 6.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0])
"""Bounds of the classes of room before a move, and the finer ones after it, in units."""
FATES = ("made", "back", "aside", "not made")
N_BEFORE, N_AFTER = len(BEFORE_EDGES) + 1, len(AFTER_EDGES) + 1
N_CONTEXTS = N_BEFORE * N_BEFORE
N_OUTCOMES = len(FATES) * N_AFTER
N_SIGNALS = N_CONTEXTS * N_OUTCOMES
PRIOR_MOVES = 2.0
"""Moves added to each context, shared out evenly over its outcomes; more trust the counts of training less."""


def outcome_probs(counts: ArrayLike) -> NDArray[np.float64]:
    """P(outcome | context, speed, type), (n_speeds, N_CONTEXTS, N_OUTCOMES, n_types), from counts of moves.

    `counts` are (n_speeds, N_SIGNALS, n_types). Thesis: §4.8.4.1.
    """
    counts = np.asarray(counts, np.float64)
    moves = counts.reshape(len(counts), N_CONTEXTS, N_OUTCOMES, -1) + PRIOR_MOVES / N_OUTCOMES
    return moves / moves.sum(axis=2, keepdims=True)


def move_signal(counts: ArrayLike) -> CategorySignal:
    """The signal model of moves from counts; contexts are as likely for all types, so that outcomes alone tell."""
    probs = outcome_probs(counts) / N_CONTEXTS
    return CategorySignal(probs.reshape(len(probs), N_SIGNALS, -1).transpose(2, 0, 1))


@kernel
def room_class(room, edges):
    """Number of the class of a room, 0 … len(edges)."""
    place = 0
    while place < len(edges) and room >= edges[place]:
        place += 1
    return place


@kernel
def room_along(clearance, x, y, dx, dy, distance):
    """The least clearance on a way along an axis; 0 where it leads into an obstacle."""
    least = clearance[y, x]
    moved = 0
    while moved < distance and least > 0:
        # No place nearer than what its clearance exceeds the least by can have less.
        moved = min(moved + max(1, int(clearance[y + dy * moved, x + dx * moved] - least)), distance)
        least = min(least, clearance[y + dy * moved, x + dx * moved])
    return least


@kernel
def move_context(field, x, y, heading, distance):
    """Number of the context of a command, 0 … N_CONTEXTS - 1: room on the spot, room along the way."""
    along = room_along(field.clearance, x, y, MOVES[heading, 0], MOVES[heading, 1], distance)
    return room_class(field.clearance[y, x], BEFORE_EDGES) * N_BEFORE + room_class(along, BEFORE_EDGES)


@kernel
def move_fate(x, y, heading, distance, x1, y1):
    """What became of a command, a number of `FATES`, by the displacement relative to it."""
    dx, dy = MOVES[heading, 0], MOVES[heading, 1]
    along = (x1 - x) * dx + (y1 - y) * dy
    across = abs((x1 - x) * dy + (y1 - y) * dx)
    if 2 * abs(along) > distance and abs(along) >= across:
        return 0 if along > 0 else 1
    return 2 if 2 * across > distance else 3


@kernel
def move_outcome(field, x, y, heading, distance, x1, y1):
    """Number of the outcome of a command, 0 … N_OUTCOMES - 1: its fate, and the room where the ball is now."""
    fate = move_fate(x, y, heading, distance, x1, y1)
    return fate * N_AFTER + room_class(field.clearance[y1, x1], AFTER_EDGES)


@kernel
def read_moves(field, before, heading, speed, x, y, signal):
    """Signals of many moves.

    Parameters
    ----------
    field : Field
    before : (n, 2) int64
        Where each ball was.
    heading : (n,) int64
        What was commanded; -1 where nothing was.
    speed : (n,) int64
        Number of the speed in force.
    x, y : (n,) int64
        Where each ball is now.
    signal : (n,) int64
        Written: context · N_OUTCOMES + outcome, or -1.
    """
    for i in range(len(heading)):
        signal[i] = -1
        if heading[i] >= 0:
            distance = field.speeds[speed[i]]
            x0, y0 = before[i, 0], before[i, 1]
            context = move_context(field, x0, y0, heading[i], distance)
            outcome = move_outcome(field, x0, y0, heading[i], distance, x[i], y[i])
            signal[i] = context * N_OUTCOMES + outcome
