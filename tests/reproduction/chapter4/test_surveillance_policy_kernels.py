import numpy as np
import pytest

from lifelore.core.errors import InputError
from reproduction.chapter4.surveillance.policy_kernels import (
    likeliest_length,
    metric_kernel,
    performance_distances,
    performance_kernel,
)

LINE = np.abs(np.arange(5.0)[:, None] - np.arange(5.0))


def test_forms_by_hand():
    near = metric_kernel(LINE, length=2.0, deviation=3.0)
    assert near[0, :3] == pytest.approx(9 * np.exp([0, -1 / 8, -1 / 2]))


def test_distances_by_hand():
    # Columns (0, 0), (3, 4): √((9 + 16) / 2).
    assert performance_distances([[0.0, 3.0], [0.0, 4.0]])[0, 1] == pytest.approx(np.sqrt(12.5))


def test_a_metric_that_is_not_euclidean_still_gives_a_covariance():
    # Two centres, each one step from all of three others, which are two steps apart: no Euclidean picture.
    gaps = np.full((5, 5), 1.0)
    gaps[:2, :2] = gaps[2:, 2:] = 2.0
    np.fill_diagonal(gaps, 0)
    raw = np.exp(-0.5 * (gaps / 3.0) ** 2)
    assert np.linalg.eigvalsh(raw)[0] < -1e-3
    kernel = metric_kernel(gaps, length=3.0, deviation=2.0)
    assert np.linalg.eigvalsh(kernel)[0] > -1e-12
    assert np.diag(kernel) == pytest.approx(4.0)
    assert kernel == pytest.approx(4 * raw, abs=0.5)


def test_the_length_that_made_the_rows_is_found():
    true = metric_kernel(np.abs(np.linspace(0, 10, 40)[:, None] - np.linspace(0, 10, 40)), length=1.5)
    rows = np.random.default_rng(0).multivariate_normal(np.zeros(40), true + 1e-8 * np.eye(40), 60)
    gaps = np.abs(np.linspace(0, 10, 40)[:, None] - np.linspace(0, 10, 40))
    # Neighbours among the lengths that are compared differ by a factor of 1.30.
    assert likeliest_length(gaps, rows, deviation=1.0) == pytest.approx(1.5, rel=0.3)


@pytest.mark.parametrize(
    ("gaps", "settings", "said"),
    [
        ([[0, 1], [2, 0]], {"length": 1}, "symmetric"),
        ([[1, 1], [1, 0]], {"length": 1}, "0 on the diagonal"),
        ([[0, -1], [-1, 0]], {"length": 1}, "at least 0"),
        ([[0, 1, 2]], {"length": 1}, "distances must be"),
        ([[0, 1], [1, 0]], {"length": 0}, "length and deviation must be positive"),
    ],
)
def test_bad_input(gaps, settings, said):
    with pytest.raises(InputError, match=said):
        metric_kernel(gaps, **settings)
    with pytest.raises(InputError, match="must differ between types"):
        performance_kernel(np.ones((2, 3)))
