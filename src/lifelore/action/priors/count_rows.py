"""Kernels on rows of counts by code: add many rows, and draw actions, without large temporary arrays.

Thesis: Eq. 3.5, 3.7 and the proportion of §3.2.2.1.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel

_DIGIT = 8
"""Bits sorted at a time; the 256 places written to fit the nearest cache."""


def merged_rows(
    codes: NDArray[np.int64], counts: NDArray[np.int64], more: NDArray[np.int64], rows: NDArray, factor: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Distinct ascending codes of both arrays, and their counts plus `factor` times each row of `more`.

    Parameters
    ----------
    codes : (n,) int64, distinct and ascending
    counts : (n, n_actions) int64
    more : (m,) int64, at least one; any order, may repeat
    rows : (m, n_actions) of integers or booleans
    factor : int
    """
    rows = np.ascontiguousarray(rows)
    if not rising(more):
        order, more = sorted_order(np.ascontiguousarray(more))
        rows = _in_order(rows, order)
    return _merge(codes, counts, np.ascontiguousarray(more), rows, factor)


def rising(codes: NDArray[np.int64]) -> bool:
    """Whether the codes are ascending; equal neighbours are allowed."""
    return bool((codes[1:] >= codes[:-1]).all())


@kernel
def _in_order(rows, order):
    # In a loop of their own these reads overlap; inside the merge each would stall it.
    result = np.empty_like(rows)
    for i in range(order.size):
        for j in range(rows.shape[1]):
            result[i, j] = rows[order[i], j]
    return result


@kernel
def sorted_order(codes):
    """Stable radix sort: the order of the codes, and the sorted codes."""
    lowest = codes.min()
    span = codes.max() - lowest
    keys, order = codes - lowest, np.arange(codes.size).astype(np.int32)
    other_keys, other_order = np.empty_like(keys), np.empty_like(order)
    shift = 0
    while shift < 63 and (span >> shift) > 0:
        place = np.zeros((1 << _DIGIT) + 1, np.int64)
        for i in range(keys.size):
            place[((keys[i] >> shift) & 255) + 1] += 1
        for digit in range(1 << _DIGIT):
            place[digit + 1] += place[digit]
        for i in range(keys.size):
            digit = (keys[i] >> shift) & 255
            other_keys[place[digit]] = keys[i]
            other_order[place[digit]] = order[i]
            place[digit] += 1
        keys, other_keys = other_keys, keys
        order, other_order = other_order, order
        shift += _DIGIT
    return order, keys + lowest


@kernel
def _merge(codes, counts, more, rows, factor):
    n, m, n_actions = codes.size, more.size, rows.shape[1]
    size = _union_size(codes, more)
    merged, total = np.empty(size, np.int64), np.zeros((size, n_actions), np.int64)
    i, j = 0, 0
    for k in range(size):
        code = codes[i] if j == m or (i < n and codes[i] <= more[j]) else more[j]
        merged[k] = code
        if i < n and codes[i] == code:
            for action in range(n_actions):
                total[k, action] = counts[i, action]
            i += 1
        while j < m and more[j] == code:
            for action in range(n_actions):
                total[k, action] += rows[j, action] * factor
            j += 1
    return merged, total


@kernel
def _union_size(codes, more):
    size, i = codes.size, 0
    for j in range(more.size):
        if j > 0 and more[j] == more[j - 1]:
            continue
        while i < codes.size and codes[i] < more[j]:
            i += 1
        if i == codes.size or codes[i] != more[j]:
            size += 1
    return size


@kernel
def draw_by_proportion(counts, place, unit, alpha0, uniform):
    """Draw an action for each place, (m,) int64, by the proportions of its row of `counts` · `unit` + `alpha0`.

    Place -1 is a row without counts. The draws are to the bit those of NumPy's cumulative proportions, because
    NumPy adds up to seven numbers in this order.
    """
    n_actions = counts.shape[1]
    actions = np.zeros(place.size, np.int64)
    mass = np.empty(n_actions)
    for i in range(place.size):
        total = 0.0
        for action in range(n_actions):
            mass[action] = alpha0 if place[i] < 0 else counts[place[i], action] * unit + alpha0
            total = mass[0] if action == 0 else total + mass[action]
        mass[0] /= total
        for action in range(1, n_actions):
            mass[action] = mass[action - 1] + mass[action] / total
        drawn, passed = uniform[i] * mass[n_actions - 1], 0
        for action in range(n_actions - 1):
            passed += drawn >= mass[action]  # without a branch, which the processor could not predict
        actions[i] = passed
    return actions


SEQUENTIAL = 7
"""Maximum number of actions for which `draw_by_proportion` adds in NumPy's order."""
