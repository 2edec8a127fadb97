"""Random numbers inside kernels: xoroshiro128+ on an explicit state, one per learner.

The state is a ``(2,) uint64`` array that the caller owns, so a learner can be stopped, stored, resumed and
run on any thread with the same result.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel

_24, _40 = np.uint64(24), np.uint64(40)
_16 = np.uint64(16)
_37, _27 = np.uint64(37), np.uint64(27)
_11 = np.uint64(11)


def random_state(generator: np.random.Generator) -> NDArray[np.uint64]:
    """A fresh ``(2,) uint64`` kernel state drawn from `generator`; never all zero."""
    state = generator.integers(0, 2**64, size=2, dtype=np.uint64)
    state[0] |= np.uint64(1)
    return state


@kernel
def next_uniform(state):
    """The next float in [0, 1), 53 bits; advances `state` in place."""
    s0 = state[0]
    s1 = state[1]
    total = s0 + s1
    s1 ^= s0
    state[0] = ((s0 << _24) | (s0 >> _40)) ^ s1 ^ (s1 << _16)
    state[1] = (s1 << _37) | (s1 >> _27)
    return np.float64(total >> _11) * (1.0 / 9007199254740992.0)


@kernel
def uniform_integer(random, n):
    """A whole number uniform over 0 … n - 1; advances `random` in place."""
    return np.int64(next_uniform(random) * n)
