"""The least belief that counts, compiled."""

import numpy as np

from lifelore.core.compiled.jit import kernel


@kernel
def least_kept(belief, mass):
    """The belief of the last type taken, in the order of belief, before `mass` of the whole is held."""
    rising = np.sort(belief)
    total = 0.0
    for i in range(rising.shape[0]):
        total += rising[i]
    left_out = 0.0
    # From below: what is left out may not exceed 1 - mass, and small numbers are summed first.
    for i in range(rising.shape[0]):
        left_out += rising[i]
        if rising[i] > 0 and left_out > (1.0 - mass) * total:
            return rising[i]
    return rising[-1]
