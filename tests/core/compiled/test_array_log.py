"""Functions of arrays beside SciPy's and beside the kernels' own, whose bits they have."""

import numpy as np
import pytest
from scipy import special

from lifelore.core.compiled import array_log, vector_log
from lifelore.core.compiled.jit import kernel

RANDOM = np.random.default_rng(0)
CASES = {
    "log": (array_log.logs, np.exp(RANDOM.uniform(-600, 600, 4000)), np.log),
    "log1p": (array_log.log1ps, np.exp(RANDOM.uniform(-600, 600, 4000)), np.log1p),
    "exp": (array_log.exps, -np.exp(RANDOM.uniform(-30, 6.5, 4000)), np.exp),
    "ndtr": (array_log.ndtrs, np.r_[RANDOM.uniform(-9, 9, 4000), 0.0, -np.inf, np.inf, 1e200], special.ndtr),
}


@kernel
def kernel_values(which, values, out):
    """Write the function of number `which` of each value."""
    for i in range(values.shape[0]):
        if which == 0:
            out[i] = vector_log.plain_log(values[i])
        elif which == 1:
            out[i] = vector_log.plain_log1p(values[i])
        elif which == 2:
            out[i] = vector_log.plain_exp(values[i])
        else:
            out[i] = vector_log.plain_ndtr(values[i])


@pytest.mark.parametrize("name", CASES)
def test_values_are_those_of_scipy_and_bits_those_of_kernels(name):
    function, values, expected = CASES[name]
    found, compiled = function(values), np.empty(values.shape)
    assert found == pytest.approx(expected(values), rel=2e-14, abs=0)
    kernel_values(list(CASES).index(name), values, compiled)
    assert np.array_equal(found, compiled)
