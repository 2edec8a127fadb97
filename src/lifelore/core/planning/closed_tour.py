"""A short closed tour of all known places, by local search.

The tour starts as a walk to the nearest place not yet visited. Two moves shorten it (Bentley 1992, with lists of
near neighbours): turn a section round (2-opt), and shift up to three places to another section (Or-opt). Then
random exchanges of two short neighbouring sections, each repaired by the same moves, stay if the tour does not get
longer (iterated local search).
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.compiled.random_state import random_state, uniform_integer
from lifelore.core.planning.near_distances import NearDistances, steps_between
from lifelore.core.streams import stream

EXCHANGES_PER_PLACE, MOST_EXCHANGES = 5, 25_000
"""Random exchanges; more give shorter tours and cost about 15 µs each. On a map of 4,461 places, the tour has 1.19
steps a place without them, and 1.11 with them."""
LONGEST_SECTION = 50
"""Places of a section that an exchange moves."""
LONGEST_TURN = 25_000
"""Largest number of places that one move turns round; without it, time would grow faster than the places."""
_LOG = 1000
"""Most moves that repair one exchange."""


def closed_tour(near: NearDistances, walk: NDArray[np.int32]) -> NDArray[np.int32]:
    """The states of `walk`, each once, in the order of a short closed tour.

    Parameters
    ----------
    near : NearDistances
    walk : (n,) int32
        Different states in the order to start from.
    """
    n = len(walk)
    tour = walk.copy()
    if n < 8:
        return tour
    position = np.full(len(near.cells), -1, np.int32)
    position[tour] = np.arange(n)
    random = random_state(stream(0, "closed tour"))
    exchanges = min(EXCHANGES_PER_PLACE * n, MOST_EXCHANGES)
    waiting, queued = tour.copy(), np.zeros(len(near.cells), np.bool_)
    _search(tour, position, near, exchanges, random, waiting, queued, np.empty((_LOG, 3), np.int32))
    return tour


def closed_length(near: NearDistances, tour: NDArray[np.int32]) -> int:
    """Steps of a closed tour."""
    return int(sum(steps_between(a, b, near) for a, b in zip(tour, np.roll(tour, -1), strict=True)))


@kernel
def nearest_walk(start, begin, ends, visited, queue, mark, walk):
    """Fill `walk` with states reached from `start`, each next one the nearest not visited; return their number.

    Of equally near states, the one with fewest neighbours not visited comes first. `visited` is changed; `mark`
    (n_states,) int32 must be -1 everywhere.
    """
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
            return count
        visited[best] = True
        walk[count] = best
        count += 1
        state = best
    return count


@kernel
def _search(tour, position, near, exchanges, random, waiting, queued, log):
    n = tour.size
    for c in tour:
        queued[c] = True
    head, count = 0, n
    while count > 0:  # no log: there is nothing to go back to
        head, count, _, _ = _improve(tour, position, near, waiting, queued, head, count, log, 0)
    for _ in range(exchanges):
        i = uniform_integer(random, n)
        most = min(LONGEST_SECTION, n // 4)
        a, b = 1 + uniform_integer(random, most), 1 + uniform_integer(random, most)
        before, first, last = tour[i], tour[(i + 1) % n], tour[(i + a) % n]
        second, end, after = tour[(i + a + 1) % n], tour[(i + a + b) % n], tour[(i + a + b + 1) % n]
        change = (
            steps_between(before, second, near)
            + steps_between(end, first, near)
            + steps_between(last, after, near)
            - steps_between(before, first, near)
            - steps_between(last, second, near)
            - steps_between(end, after, near)
        )
        n_log = _turn(tour, position, first, end, a + b, log, 0)
        n_log = _turn(tour, position, end, second, b, log, n_log)
        n_log = _turn(tour, position, last, first, a, log, n_log)
        head, count = 0, 0
        for c in (before, first, last, second, end, after):
            count = _wait(c, waiting, queued, head, count)
        while count > 0:
            head, count, gain, n_log = _improve(tour, position, near, waiting, queued, head, count, log, n_log)
            change -= gain
            if n_log + 8 > log.shape[0]:
                while count > 0:
                    queued[waiting[head]] = False
                    head, count = (head + 1) % n, count - 1
        if change > 0:
            for k in range(n_log - 1, -1, -1):
                _turn(tour, position, log[k, 1], log[k, 0], log[k, 2], log, log.shape[0])


@kernel
def _wait(c, waiting, queued, head, count):
    if not queued[c]:
        queued[c] = True
        waiting[(head + count) % waiting.size] = c
        count += 1
    return count


@kernel
def _turn(tour, position, first, last, length, log, n_log):
    """Turn the section of `length` places with the ends `first` and `last` round; returns the longer log.

    The length tells the section from the rest of the tour with the same ends: it must not be half of the tour
    and one.
    """
    n = tour.size
    i, j = position[first], position[last]
    if (j - i) % n + 1 != length:
        i, j = j, i
    if n_log < log.shape[0]:
        log[n_log, 0], log[n_log, 1], log[n_log, 2] = first, last, length
    if 2 * length > n:  # to turn the rest round gives the same closed tour
        i, j, length = (j + 1) % n, (i - 1) % n, n - length
    for _ in range(length // 2):
        a, b = tour[i], tour[j]
        tour[i], tour[j] = b, a
        position[b], position[a] = i, j
        i += 1
        if i == n:
            i = 0
        j -= 1
        if j < 0:
            j = n - 1
    return n_log + 1


@kernel
def _improve(tour, position, near, waiting, queued, head, count, log, n_log):
    """Take a place from the queue and make the first move there that shortens the tour.

    Returns the queue's head and number of places, the steps saved, and the number of logged turns.
    """
    n = tour.size
    nearest = near.nearest
    c = waiting[head]
    head, count = (head + 1) % n, count - 1
    queued[c] = False
    for forward in (1, -1):  # 2-opt: join c and x, and what follows them
        s = tour[(position[c] + forward) % n]
        old = steps_between(c, s, near)
        for k in range(nearest.shape[1]):
            x = nearest[c, k]
            if x < 0 or old <= steps_between(c, x, near):
                break
            if position[x] < 0 or x == s:
                continue
            y = tour[(position[x] + forward) % n]
            if y == c:
                continue
            gain = old + steps_between(x, y, near) - steps_between(c, x, near) - steps_between(s, y, near)
            length = ((position[x] - position[s]) * forward) % n + 1
            if gain <= 0 or min(length, n - length) > LONGEST_TURN or 2 * length - 2 == n:
                continue
            n_log = _turn(tour, position, s, x, length, log, n_log)
            for v in (c, s, x, y):
                count = _wait(v, waiting, queued, head, count)
            return head, count, gain, n_log
    for length in range(1, 4):  # Or-opt: shift the places c … e between x and y
        for forward in (1, -1):
            at = position[c]
            e = tour[(at + forward * (length - 1)) % n]
            p, q = tour[(at - forward) % n], tour[(at + forward * length) % n]
            old = steps_between(p, c, near) + steps_between(e, q, near) - steps_between(p, q, near)
            for k in range(nearest.shape[1]):
                x = nearest[c, k]
                if x < 0 or old <= steps_between(c, x, near):
                    break
                if position[x] < 0:
                    continue
                away = ((position[x] - at) * forward) % n
                if away < length:
                    continue
                for side in (1, -1):
                    y = tour[(position[x] + side * forward) % n]
                    behind = ((position[y] - at) * forward) % n
                    if behind < length:
                        continue
                    gain = old + steps_between(x, y, near) - steps_between(c, x, near) - steps_between(e, y, near)
                    gap = min(away, behind) - length + 1
                    back = n - length - gap
                    turned = length + min(gap, back)
                    if gain <= 0 or turned > LONGEST_TURN or 2 * turned - 2 == n or 2 * (turned - length) - 2 == n:
                        continue
                    n_log = _shift(tour, position, c, e, p, q, x, y, length, side == 1, gap, back, log, n_log)
                    for v in (c, e, p, q, x, y):
                        count = _wait(v, waiting, queued, head, count)
                    return head, count, gain, n_log
    return head, count, 0, n_log


@kernel
def _shift(tour, position, c, e, p, q, x, y, length, x_first, gap, back, log, n_log):
    """Shift c … e between x and y with c beside x, by turning sections round.

    In the direction from c to e the tour is p, c … e, q … then x, y or y, x, then … p. `gap` places lie from q to
    the nearer of x and y, `back` places from the farther to p.
    """
    near_end, far_end = (x, y) if x_first else (y, x)
    if gap <= back:  # c … e changes places with q … near_end
        n_log = _turn(tour, position, c, near_end, length + gap, log, n_log)
        n_log = _turn(tour, position, near_end, q, gap, log, n_log)
        if x_first:
            n_log = _turn(tour, position, e, c, length, log, n_log)
    else:  # c … e changes places with far_end … p
        n_log = _turn(tour, position, far_end, e, length + back, log, n_log)
        n_log = _turn(tour, position, p, far_end, back, log, n_log)
        if x_first:
            n_log = _turn(tour, position, e, c, length, log, n_log)
    return n_log
