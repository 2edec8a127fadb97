"""Expansions beside the direct sum, and their bound."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.perception.separation.far_field import WIDEST, far_field, far_field_cells

ROUNDING = 1e-13


def direct_sums(points, sources, weights):
    """The obvious double sum, with NumPy's exponential."""
    squared = ((points[:, :, None] - sources[:, None, :]) ** 2).sum(axis=0)
    return np.exp(-squared / 2) @ weights


def clouds(seed, n_cells=5, n_sources=30, spread=3.0, reach=0.25):
    """Points in cells of half-edge `reach`, and sources about them."""
    random = np.random.default_rng(seed)
    counts = random.integers(1, 200, n_cells)
    corners = random.uniform(-spread, spread, (3, n_cells))
    points = np.repeat(corners, counts, axis=1) + random.uniform(-reach, reach, (3, counts.sum()))
    sources = random.uniform(-spread, spread, (3, n_sources))
    starts = np.append(0, np.cumsum(counts))
    return points, starts, sources, random.normal(size=n_sources)


def test_order_one_by_hand():
    # One source at distance 1 along x, one point at 0.1 from the centre: e^{-1/2} e^{-0.005} (1 + 0.1).
    points = np.array([[0.1, -0.1], [0.0, 0.0], [0.0, 0.0]])
    sums, error = far_field(
        points, far_field_cells(points, np.array([0, 2])), np.array([[1.0], [0], [0]]), np.ones(1), 1
    )
    assert sums == pytest.approx(np.exp(-0.505) * np.array([1.1, 0.9]), rel=1e-14)
    # What is left out: t²/2! / (1 - t/3) of e^{-1/2}, with t = 0.1.
    assert error == pytest.approx(np.exp(-0.5) * 0.005 / (1 - 0.1 / 3), rel=1e-9)


@given(
    st.integers(0, 10**6), st.integers(1, 8), st.sampled_from([0.01, 0.1, 0.28]), st.sampled_from([0.5, 3.0, 20.0])
)
@settings(max_examples=60, deadline=None)
def test_the_bound_holds(seed, order, reach, spread):
    points, starts, sources, weights = clouds(seed, spread=spread, reach=reach)
    cells = far_field_cells(points, starts)
    assert cells.radius.max() <= WIDEST
    sums, error = far_field(points, cells, sources, weights, order)
    exact = direct_sums(points, sources, weights)
    assert (np.abs(sums - exact) <= error + ROUNDING * np.abs(weights).sum()).all()


def test_higher_orders_are_closer_and_their_bounds_no_fable():
    points, starts, sources, weights = clouds(1, n_sources=300)
    exact = direct_sums(points, sources, weights)
    worst = []
    for order in (2, 4, 6, 8):
        sums, error = far_field(points, far_field_cells(points, starts), sources, weights, order)
        worst.append(np.abs(sums - exact).max())
        assert error.max() < 100 * worst[-1] + 1e-12
    assert all(b < a / 5 for a, b in pairwise(worst))


def test_more_sources_and_points_than_go_through_at_once():
    points, starts, sources, weights = clouds(2, n_cells=2, n_sources=515)
    points = np.ascontiguousarray(np.repeat(points, 3, axis=1))
    cells = far_field_cells(points, starts * 3)
    sums, error = far_field(points, cells, sources, weights, 7)
    assert np.abs(sums - direct_sums(points, sources, weights)).max() <= error.max() + 1e-12
