"""Sequential minimal optimisation of a soft-margin dual over a working set (Fan, Chen, Lin 2005: WSS 2).

With signed multipliers β = yα the dual is: maximise Σ yβ - ½ βᵀKβ, Σβ = 0, lower ≤ β ≤ upper. Its slope is
r = y - Kβ; optimal means max{r : β < upper} ≤ min{r : β > lower}. A step moves β_i up and β_j down.
"""

import numpy as np

from lifelore.core.jit import kernel
from lifelore.perception.gaussian import Array, kernel_row

_LEAST_CURVATURE = 1e-12
"""Two points at one place have none; libsvm's τ."""


@kernel
def ascend(
    points: Array, lower: Array, upper: Array, beta: Array, slope: Array, tolerance: float, max_steps: int
) -> int:
    """Change `beta` and its `slope` in place until the violation is below `tolerance`; the steps taken.

    points : (3, m), all others (m,); rows of the kernel matrix are computed when first needed.
    """
    m = beta.shape[0]
    rows = np.empty((m, m))
    known = np.zeros(m, np.bool_)
    for step in range(max_steps):
        i, most, least = 0, -np.inf, np.inf
        for k in range(m):
            if beta[k] < upper[k] and slope[k] > most:
                i, most = k, slope[k]
            if beta[k] > lower[k] and slope[k] < least:
                least = slope[k]
        if most - least < tolerance:
            return step
        if not known[i]:
            kernel_row(points, i, rows[i])
            known[i] = True
        row_i = rows[i]
        j, best = 0, -1.0
        for k in range(m):
            rise = most - slope[k]
            if beta[k] > lower[k] and rise > 0.0:
                gain = rise * rise / max(2.0 - 2.0 * row_i[k], _LEAST_CURVATURE)
                if gain > best:
                    j, best = k, gain
        if not known[j]:
            kernel_row(points, j, rows[j])
            known[j] = True
        row_j = rows[j]
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
