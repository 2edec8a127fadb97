"""A short closed tour of all known places, by local search.

The tour starts as a walk to the nearest place not yet visited. Turning sections round shortens it (2-opt with
lists of near neighbours, Bentley 1992). Then random exchanges of two short neighbouring sections, each repaired by
the same move, stay if the tour does not get longer (iterated local search).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.compiled.random_state import random_state, uniform_integer
from lifelore.core.planning.near_distances import NearDistances, steps_between
from lifelore.core.streams import stream

EXCHANGES_PER_PLACE, MOST_EXCHANGES = 5, 25_000
"""Random exchanges; more give shorter tours and cost about 15 µs each. On a map of 4,461 places, the tour has 1.22
steps a place without them, and 1.10 with them."""
LONGEST_SECTION = 50
"""Places of a section that an exchange moves."""
LONGEST_TURN = 25_000
"""Largest number of places that one move turns round; without it, time would grow faster than the places."""
_LOG = 1000
"""Most moves that repair one exchange."""
HEAD, COUNT, LOGGED = range(3)
"""Places in `TourInWork.cursor`: start and number of the places in the queue, and number of logged turns."""


class TourInWork(NamedTuple):
    """A tour while moves shorten it; changed in place.

    order : (n,) int32, the states in the order of the tour
    position : (n_states,) int32, index of each state in the order, -1 for states not on the tour
    waiting : (n,) int32, queue of the states at which moves are tried next, as a ring
    queued : (n_states,) bool, whether a state waits
    log : (_LOG, 3) int32, first and last place and length of each turn since the last exchange
    cursor : (3,) int64, see `HEAD` and the constants beside it
    """

    order: NDArray[np.int32]
    position: NDArray[np.int32]
    waiting: NDArray[np.int32]
    queued: NDArray[np.bool_]
    log: NDArray[np.int32]
    cursor: NDArray[np.int64]


def closed_tour(near: NearDistances, walk: NDArray[np.int32]) -> NDArray[np.int32]:
    """The states of `walk`, each once, in the order of a short closed tour.

    Parameters
    ----------
    near : NearDistances
    walk : (n,) int32
        Different states in the order to start from.
    """
    n = len(walk)
    if n < 8:
        return walk.copy()
    position, queued = np.full(len(near.cells), -1, np.int32), np.zeros(len(near.cells), np.bool_)
    position[walk], queued[walk] = np.arange(n), True
    log, cursor = np.empty((_LOG, 3), np.int32), np.array([0, n, 0])
    tour = TourInWork(walk.copy(), position, walk.copy(), queued, log, cursor)
    random = random_state(stream(0, "closed tour"))
    _shorten(tour, near, min(EXCHANGES_PER_PLACE * n, MOST_EXCHANGES), random)
    return tour.order


@kernel
def nearest_walk(start, begin, ends, visited, length):
    """States reached from `start`, each next one the nearest not visited, (at most `length`,) int32.

    Of equally near states, the one with fewest neighbours not visited comes first. `visited` is changed.
    """
    queue, mark = np.empty(visited.size, np.int32), np.full(visited.size, np.int32(-1))
    walk = np.empty(length, np.int32)
    visited[start] = True
    walk[0] = start
    count, state = 1, start
    while count < walk.size:
        queue[0] = state
        mark[state] = count
        head, tail, level_end = 0, 1, 1
        best, fewest = -1, 0
        while head < tail:
            if head == level_end:
                if best >= 0:
                    break
                level_end = tail
            s = queue[head]
            head += 1
            for k in range(begin[s], begin[s + 1]):
                t = ends[k]
                if mark[t] == count:
                    continue
                mark[t] = count
                queue[tail] = t
                tail += 1
                if not visited[t]:
                    left = 0
                    for j in range(begin[t], begin[t + 1]):
                        left += not visited[ends[j]]
                    if best < 0 or left < fewest:
                        best, fewest = t, left
        if best < 0:
            break
        visited[best] = True
        walk[count] = best
        count += 1
        state = best
    return walk[:count]


@kernel
def _shorten(tour, near, exchanges, random):
    """Improve at every place that waits; then exchange neighbouring sections, so often, and keep what helps."""
    order, cursor, log = tour.order, tour.cursor, tour.log
    n = order.size
    while cursor[COUNT] > 0:
        _improve(tour, near)
        cursor[LOGGED] = 0  # there is nothing to go back to
    for _ in range(exchanges):
        i = uniform_integer(random, n)
        most = min(LONGEST_SECTION, n // 4)
        a, b = 1 + uniform_integer(random, most), 1 + uniform_integer(random, most)
        before, first, last = order[i], order[(i + 1) % n], order[(i + a) % n]
        second, end, after = order[(i + a + 1) % n], order[(i + a + b) % n], order[(i + a + b + 1) % n]
        change = (
            steps_between(before, second, near)
            + steps_between(end, first, near)
            + steps_between(last, after, near)
            - steps_between(before, first, near)
            - steps_between(last, second, near)
            - steps_between(end, after, near)
        )
        cursor[LOGGED] = 0
        _turn(tour, first, end, a + b)
        _turn(tour, end, second, b)
        _turn(tour, last, first, a)
        for c in (before, first, last, second, end, after):
            _wait(tour, c)
        while cursor[COUNT] > 0:
            change -= _improve(tour, near)
            if cursor[LOGGED] + 8 > log.shape[0]:
                while cursor[COUNT] > 0:
                    _next_waiting(tour)
        if change > 0:
            for k in range(cursor[LOGGED] - 1, -1, -1):
                cursor[LOGGED] = log.shape[0]  # turns back are not logged
                _turn(tour, log[k, 1], log[k, 0], log[k, 2])


@kernel
def _wait(tour, c):
    """Put a place into the queue, if it is not there."""
    waiting, queued, cursor = tour.waiting, tour.queued, tour.cursor
    if not queued[c]:
        queued[c] = True
        waiting[(cursor[HEAD] + cursor[COUNT]) % waiting.size] = c
        cursor[COUNT] += 1


@kernel
def _next_waiting(tour):
    """Take the first place from the queue."""
    waiting, queued, cursor = tour.waiting, tour.queued, tour.cursor
    c = waiting[cursor[HEAD]]
    cursor[HEAD] = (cursor[HEAD] + 1) % waiting.size
    cursor[COUNT] -= 1
    queued[c] = False
    return c


@kernel
def _turn(tour, first, last, length):
    """Turn the section of `length` places with the ends `first` and `last` round, and log it.

    The length tells the section from the rest of the tour with the same ends: it must not be half of the tour
    and one.
    """
    order, position, log, cursor = tour.order, tour.position, tour.log, tour.cursor
    n = order.size
    i, j = position[first], position[last]
    if (j - i) % n + 1 != length:
        i, j = j, i
    if cursor[LOGGED] < log.shape[0]:
        log[cursor[LOGGED], 0], log[cursor[LOGGED], 1], log[cursor[LOGGED], 2] = first, last, length
        cursor[LOGGED] += 1
    if 2 * length > n:  # to turn the rest round gives the same closed tour
        i, j, length = (j + 1) % n, (i - 1) % n, n - length
    for _ in range(length // 2):
        a, b = order[i], order[j]
        order[i], order[j] = b, a
        position[b], position[a] = i, j
        i += 1
        if i == n:
            i = 0
        j -= 1
        if j < 0:
            j = n - 1


@kernel
def _improve(tour, near):
    """Make the first move that shortens the tour at the next place of the queue; returns the steps saved."""
    order, position, nearest = tour.order, tour.position, near.nearest
    n = order.size
    c = _next_waiting(tour)
    for forward in (1, -1):  # 2-opt: join c and x, and what follows them
        s = order[(position[c] + forward) % n]
        old = steps_between(c, s, near)
        for k in range(nearest.shape[1]):
            x = nearest[c, k]
            if x < 0 or old <= steps_between(c, x, near):
                break
            if position[x] < 0 or x == s:
                continue
            y = order[(position[x] + forward) % n]
            if y == c:
                continue
            gain = old + steps_between(x, y, near) - steps_between(c, x, near) - steps_between(s, y, near)
            length = ((position[x] - position[s]) * forward) % n + 1
            if gain <= 0 or min(length, n - length) > LONGEST_TURN or 2 * length - 2 == n:
                continue
            _turn(tour, s, x, length)
            for v in (c, s, x, y):
                _wait(tour, v)
            return gain
    return 0
