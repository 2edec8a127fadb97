"""Sequential minimal optimisation of a soft-margin dual over a working set (Fan, Chen, Lin 2005: WSS 2).

With signed multipliers β = yα the dual is: maximise Σ yβ - ½ βᵀKβ, Σβ = 0, lower ≤ β ≤ upper. Its slope is
r = y - Kβ; optimal means max{r : β < upper} ≤ min{r : β > lower}. A step moves β_i up and β_j down.
"""

import numpy as np

from lifelore.core.compiled.jit import kernel
from lifelore.perception.separation.gaussian import Array, kernel_row

_LEAST_CURVATURE = 1e-12
"""Least curvature, for two points at one position; libsvm's τ."""
MOST_KEPT = 2**26
"""Largest number of stored kernel values, half a gigabyte; beyond it rows are computed again."""


@kernel
def ascend(
    points: Array, lower: Array, upper: Array, beta: Array, slope: Array, tolerance: float, max_steps: int
) -> int:
    """Change `beta` and its `slope` in place until the violation is below `tolerance`; returns the number of
    steps.

    points : (3, m), all others (m,); rows of the kernel matrix are computed when first needed.
    """
    m = beta.shape[0]
    room = max(2, min(m, MOST_KEPT // m))
    # Row place[i] of `rows` is row i of the kernel matrix; place[i] is -1 if it is not computed.
    rows, place = np.empty((room, m)), np.full(m, -1)
    n_rows = 0
    for step in range(max_steps):
        i, most, least = 0, -np.inf, np.inf
        for k in range(m):
            if beta[k] < upper[k] and slope[k] > most:
                i, most = k, slope[k]
            if beta[k] > lower[k] and slope[k] < least:
                least = slope[k]
        if most - least < tolerance:
            return step
        if room < m and n_rows + 2 > room:
            place[:] = -1
            n_rows = 0
        if place[i] < 0:
            kernel_row(points, i, rows[n_rows])
            place[i] = n_rows
            n_rows += 1
        row_i = rows[place[i]]
        j, best = 0, -1.0
        for k in range(m):
            rise = most - slope[k]
            if beta[k] > lower[k] and rise > 0.0:
                gain = rise * rise / max(2.0 - 2.0 * row_i[k], _LEAST_CURVATURE)
                if gain > best:
                    j, best = k, gain
        if place[j] < 0:
            kernel_row(points, j, rows[n_rows])
            place[j] = n_rows
            n_rows += 1
        row_j = rows[place[j]]
        move = (most - slope[j]) / max(2.0 - 2.0 * row_i[j], _LEAST_CURVATURE)
        room_i, room_j = upper[i] - beta[i], beta[j] - lower[j]
        if room_i <= move and room_i <= room_j:
            move = room_i
            beta[i], beta[j] = upper[i], beta[j] - move
        elif room_j <= move:
            move = room_j
            beta[i], beta[j] = beta[i] + move, lower[j]
        else:
            beta[i], beta[j] = beta[i] + move, beta[j] - move
        for k in range(m):
            slope[k] -= move * (row_i[k] - row_j[k])
    return max_steps
