"""Logarithms and exponentials of kernels: as accurate as those of the standard library, compiled and plain."""

import math

import numba
import numpy as np

from lifelore.core.compiled.vector_log import plain_exp, plain_log, plain_log1p


@numba.njit
def both(values, logs, logs1p):
    for i in range(values.shape[0]):
        logs[i], logs1p[i] = plain_log(values[i]), plain_log1p(values[i])


def test_logarithms_have_the_digits_of_the_standard_library():
    random = np.random.default_rng(0)
    values = np.concatenate([
        10 ** random.uniform(-300, 300, 20_000), random.uniform(0, 3, 20_000),
        10 ** random.uniform(-20, 2, 20_000),
        [1.0, 2.0, 0.5, math.sqrt(2), math.sqrt(0.5), math.sqrt(2) - 1, 1e300, 5e-308],
    ])  # fmt: skip
    logs, logs1p = np.empty_like(values), np.empty_like(values)
    both(values, logs, logs1p)
    # Two units of the last place; log1p of the smallest also relative to themselves.
    np.testing.assert_allclose(logs, np.log(values), rtol=5e-16, atol=1e-300)
    np.testing.assert_allclose(logs1p, np.log1p(values), rtol=5e-16, atol=0)
    assert plain_log(1.0) == plain_log1p(0.0) == 0.0


@numba.njit
def exponentials(values, out):
    for i in range(values.shape[0]):
        out[i] = plain_exp(values[i])


def test_exponentials_have_the_digits_of_the_standard_library():
    random = np.random.default_rng(0)
    values = -np.concatenate([10 ** random.uniform(-20, 2.8, 50_000), [0.0, 707.0, 709.0, 1e300]])
    out = np.empty_like(values)
    exponentials(values, out)
    expected = np.where(values < -708, 0.0, np.exp(values))
    np.testing.assert_allclose(out, expected, rtol=5e-16, atol=0)


def test_plain_python_gives_the_same():
    for value in (1e-200, 1e-9, 0.3, 1.0, 7.5, 1e200):
        assert math.isclose(plain_log.py_func(value), math.log(value), rel_tol=5e-16, abs_tol=1e-300)
        assert math.isclose(plain_log1p.py_func(value), math.log1p(value), rel_tol=5e-16)
        assert math.isclose(plain_exp.py_func(-value), math.exp(-value), rel_tol=5e-16)
