"""Compiled kernel: join neighbouring bins so that least information about the type is lost."""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel

Array = NDArray[np.float64]


@kernel
def _information(bins: Array, first: int, second: int) -> float:
    """n_types times the information about the type, in nats, that is lost when two bins are joined."""
    both = 0.0
    one = 0.0
    other = 0.0
    lost = 0.0
    for i in range(bins.shape[1]):
        a, b = bins[first, i], bins[second, i]
        one += a
        other += b
        both += a + b
        if a > 0:
            lost += a * np.log(a)
        if b > 0:
            lost += b * np.log(b)
        if a + b > 0:
            lost -= (a + b) * np.log(a + b)
    if one > 0:
        lost -= one * np.log(one)
    if other > 0:
        lost -= other * np.log(other)
    if both > 0:
        lost += both * np.log(both)
    return lost


@kernel
def joined_ends(bins: Array, n_bins: int) -> NDArray[np.int64]:
    """The end of each joined bin, (n_bins,); `bins` (n, n_types) is summed up in place."""
    n = bins.shape[0]
    after = np.arange(1, n + 1)
    before = np.arange(-1, n - 1)
    loss = np.full(n, np.inf)
    for k in range(n - 1):
        loss[k] = _information(bins, k, k + 1)
    for _ in range(n - n_bins):
        k = int(np.argmin(loss))
        gone = after[k]
        for i in range(bins.shape[1]):
            bins[k, i] += bins[gone, i]
        after[k] = after[gone]
        loss[gone] = np.inf
        if after[k] < n:
            before[after[k]] = k
            loss[k] = _information(bins, k, after[k])
        else:
            loss[k] = np.inf
        if before[k] >= 0:
            loss[before[k]] = _information(bins, before[k], k)
    ends = np.empty(n_bins, np.int64)
    k = 0
    for j in range(n_bins):
        k = after[k]
        ends[j] = k
    return ends
