"""Finds codes in a sorted array of codes: a table of buckets by the leading bits, then bisection in the bucket.

Many lookups in a long array take one or two memory accesses each, a plain bisection some twenty. Unlike a hash
table, it stays fast if many codes fall into one bucket.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel

FEW = 1 << 14
"""Number of lookups up to which plain bisection is faster than building the table."""


class ContextIndex:
    """Index of `codes`, (n,) int64, distinct and ascending; the array must not change."""

    def __init__(self, codes: NDArray[np.int64]) -> None:
        self.codes = codes
        self._buckets: tuple[NDArray[np.int32], int] | None = None

    def places(self, wanted: NDArray[np.int64]) -> NDArray[np.int64]:
        """Place of each wanted code in `codes`, (m,) int64; -1 if it is missing."""
        codes = self.codes
        if not len(codes) or not len(wanted):
            return np.full(len(wanted), -1, np.int64)
        if len(wanted) == len(codes) and wanted[0] == codes[0] and np.array_equal(wanted, codes):
            return np.arange(len(codes))
        if len(wanted) < FEW:
            place = np.minimum(np.searchsorted(codes, wanted), len(codes) - 1)
            return np.where(codes[place] == wanted, place, -1)
        if self._buckets is None:
            self._buckets = _buckets(codes)
        start, shift = self._buckets
        return _look_up(codes, start, shift, np.ascontiguousarray(wanted))


def _buckets(codes: NDArray[np.int64]) -> tuple[NDArray[np.int32], int]:
    """First place of each bucket, then the number of codes; and the bits to shift code - codes[0] by."""
    span = int(codes[-1]) - int(codes[0])
    shift = max(0, span.bit_length() - (2 * len(codes)).bit_length())
    start = np.empty((span >> shift) + 2, np.int32)
    _fill(codes, shift, start)
    return start, shift


@kernel
def _fill(codes, shift, start):
    bucket = 0
    for i in range(codes.size):
        own = (codes[i] - codes[0]) >> shift
        while bucket <= own:
            start[bucket] = i
            bucket += 1
    start[bucket] = codes.size


@kernel
def _look_up(codes, start, shift, wanted):
    place = np.full(wanted.size, -1, np.int64)
    lowest, highest = codes[0], codes[-1]
    for i in range(wanted.size):
        code = wanted[i]
        if code < lowest or code > highest:
            continue
        bucket = (code - lowest) >> shift
        low, high = start[bucket], start[bucket + 1]
        while low < high:
            middle = (low + high) >> 1
            if codes[middle] < code:
                low = middle + 1
            else:
                high = middle
        if low < codes.size and codes[low] == code:
            place[i] = low
    return place
