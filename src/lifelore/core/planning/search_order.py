"""The order in which to visit places when the goal may be in any of them: least mean time until it is found.

The goal is found when its place is entered, so the mean time is the mean of the places' times of arrival (the
minimum latency problem). The order begins as the rest of a short closed tour, entered and left in the best of
several ways, and is improved by turning sections round and by exchanging neighbouring sections.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.planning.near_distances import NearDistances, steps_between

MOST_UPDATES = 2e8
"""Most changes of times of arrival in one improvement, about a third of a second; more help in large maps."""


def search_order(
    near: NearDistances, tour: NDArray[np.int32], wanted: NDArray[np.bool_], start: int, nearest: int
) -> NDArray[np.int32]:
    """The wanted states of a tour in the order in which to visit them from `start`.

    Parameters
    ----------
    near : NearDistances
    tour : (n,) int32
        A closed tour.
    wanted : (n_states,) bool
        States to visit; at least `nearest` is.
    start : int
    nearest : int
        The wanted state nearest to `start`.
    """
    rest = tour[wanted[tour]]
    rest = rest[rest != start]
    if len(rest) < 2:
        return rest
    ways = [np.r_[np.int32(start), way] for way in _ways(near, rest, int(np.flatnonzero(rest == nearest)[0]))]
    times = [arrival_times(way, near).sum() for way in ways]
    order = ways[int(np.argmin(times))]
    _improve_order(order, arrival_times(order, near), near, np.full(len(near.cells), -1))
    return order[1:]


def _ways(near: NearDistances, rest: NDArray[np.int32], at: int) -> list[NDArray[np.int32]]:
    """Ways through a closed tour: from its place number `at` in both directions, and from the ends of its longest
    gap. Where a way meets the end, it may go on as before or turn."""
    ways = []
    for tour, begin in ((rest, at), (rest[::-1], len(rest) - 1 - at)):
        ways += [np.r_[tour[begin:], tour[:begin]], np.r_[tour[begin:], tour[:begin][::-1]]]
    gaps = _steps_along(np.r_[rest, rest[:1]], near)
    turned = np.roll(rest, -1 - int(np.argmax(gaps)))
    return [*ways, turned, turned[::-1]]


@kernel
def _steps_along(way, near):
    steps = np.empty(way.size - 1, np.int64)
    for i in range(way.size - 1):
        steps[i] = steps_between(way[i], way[i + 1], near)
    return steps


def arrival_times(way: NDArray[np.int32], near: NearDistances) -> NDArray[np.int64]:
    """Steps until each state of a way is entered, (n,); 0 at the first."""
    return np.r_[0, np.cumsum(_steps_along(way, near))]


@kernel
def _improve_order(way, time, near, position):
    """Improve a way, of which the first place is fixed, until no move helps; changes `way` and `time`."""
    m = way.size
    total = np.cumsum(time)
    waiting, queued, section = way.copy(), np.zeros(position.size, np.bool_), np.empty(m, way.dtype)
    for i in range(m):
        position[way[i]] = i
        queued[way[i]] = True
    head, count, updates = 0, m, 0.0
    while count > 0 and updates < MOST_UPDATES:
        c = waiting[head]
        head, count = (head + 1) % m, count - 1
        queued[c] = False
        turn, i, j, k = _best_move(c, way, time, total, near, position)
        if i < 0:
            continue
        for p in (i - 1, i, j, j + 1, k, k + 1):
            v = way[min(p, m - 1)]
            if not queued[v]:
                queued[v] = True
                waiting[(head + count) % m] = v
                count += 1
        if turn:
            way[i : k + 1] = way[i : k + 1][::-1].copy()
        else:
            section[: j + 1 - i] = way[i : j + 1]
            way[i : i + k - j] = way[j + 1 : k + 1]
            way[i + k - j : k + 1] = section[: j + 1 - i]
        for p in range(i, k + 1):
            position[way[p]] = p
        before = time[min(k + 1, m - 1)]
        for p in range(i, min(k + 2, m)):
            time[p] = time[p - 1] + steps_between(way[p - 1], way[p], near)
        if k + 1 < m:
            time[k + 2 :] += time[k + 1] - before
        for p in range(i, m):
            total[p] = total[p - 1] + time[p]
        updates += m - i


@kernel
def _best_move(c, way, time, total, near, position):
    """The move that brings place `c` beside a near one and lowers the sum of times most.

    Returns whether to turn round the places i … k, or else exchange i … j with j + 1 … k; i is -1 if none helps.
    """
    m = way.size
    at, best = position[c], 0
    found = (False, -1, -1, -1)
    for n in range(near.nearest.shape[1]):
        x = near.nearest[c, n]
        if x < 0:
            break
        other = position[x]
        if other < 0:
            continue
        for i, k in ((at + 1, other), (at, other - 1)):
            if 1 <= i < k:
                change = _if_turned(way, time, total, near, i, k)
                if change < best:
                    best, found = change, (True, i, i, k)
        for length in range(1, 4):
            for first in (at, at - length + 1):
                last = first + length - 1
                if first < 1 or last >= m or first <= other <= last:
                    continue
                for side in (0, 1):
                    if other < first:
                        i, j, k = other + side, first - 1, last
                    else:
                        i, j, k = first, last, other - side
                    if 1 <= i <= j < k:
                        change = _if_exchanged(way, time, near, i, j, k)
                        if change < best:
                            best, found = change, (False, i, j, k)
    return found


@kernel
def _if_turned(way, time, total, near, i, k):
    """Change of the sum of times if the places i … k are turned round."""
    m = way.size
    reach = time[i - 1] + steps_between(way[i - 1], way[k], near) + time[k]
    inside = total[k] - total[i - 1]
    change = (k - i + 1) * reach - 2 * inside
    if k + 1 < m:
        change += (reach - time[i] + steps_between(way[i], way[k + 1], near) - time[k + 1]) * (m - 1 - k)
    return change


@kernel
def _if_exchanged(way, time, near, i, j, k):
    """Change of the sum of times if the places i … j and j + 1 … k change places."""
    m = way.size
    sooner = time[i - 1] + steps_between(way[i - 1], way[j + 1], near) - time[j + 1]
    later = time[k] + sooner + steps_between(way[k], way[i], near) - time[i]
    change = (k - j) * sooner + (j - i + 1) * later
    if k + 1 < m:
        change += (time[j] + later + steps_between(way[j], way[k + 1], near) - time[k + 1]) * (m - 1 - k)
    return change
