"""The cost of a line: against dense samples of it, and lines whose cost is worked by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import KDTree

from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.line_of_sight import TIGHT, Ground, ground_of, line_cost
from lifelore.domains.buildings.occupancy_map import OCCUPIED, OccupancyMap

SAMPLES = 20_001


def ground(solid: np.ndarray, state: np.ndarray, price: np.ndarray, radius: float = 2.0) -> Ground:
    """Pixels of 0.1 m; `radius` and `price` in pixels."""
    occupancy = OccupancyMap(solid.astype(np.uint8) * OCCUPIED, 0.1)
    floor = Floor(occupancy, state, solid, 0.1 * radius, np.full((len(price), 4), -1, np.int32))
    return ground_of(floor, 0.1 * price)


def cost_of_samples(on: Ground, a: np.ndarray, b: np.ndarray) -> float | None:
    """As `line_cost`; None if a sample or a step between samples is too near to a border for a verdict."""
    points = np.linspace(a, b, SAMPLES)
    pixels = np.rint(points).astype(int)
    length = float(np.hypot(*(b - a)))
    steps = np.diff(pixels, axis=0)
    if (np.abs(steps).sum(axis=1) > 1).any():
        return None
    states = on.state[tuple(pixels.T)]
    if (states < 0).any():
        return np.inf
    nearest = KDTree(np.argwhere(on.solid)).query(points)[0].min() if on.solid.any() else np.inf
    if min(abs(nearest - on.radius), abs(nearest - on.wanted)) < 1e-4:
        return None
    price = 0.0
    for k in np.flatnonzero(np.diff(states)):
        down, right = steps[k]
        action = (1 if down > 0 else 0) if down else (2 if right > 0 else 3)
        price += on.price[states[k], action]
    if nearest <= on.radius:
        return np.inf
    return length + (TIGHT * length if nearest < on.wanted else 0.0) + price


@given(seed=st.integers(0, 2**32 - 1))
def test_the_cost_is_that_of_dense_samples(seed):
    rng = np.random.default_rng(seed)
    solid = rng.random((18, 21)) < 0.02
    cells = np.add.outer(np.arange(18) // 4 * 6, np.arange(21) // 4).astype(np.int32)
    state = np.where(rng.random(solid.shape) < 0.01, np.int32(-1), cells)
    price = np.where(rng.random((30, 4)) < 0.05, np.inf, rng.uniform(0, 5, (30, 4)))
    on = ground(solid, state, price, radius=float(rng.choice([0.0, 1.0, 2.0])))
    a, b = rng.uniform(0, 17, 2), rng.uniform(0, 17, 2)
    expected = cost_of_samples(on, a, b)
    if expected is not None and state[tuple(np.rint(a).astype(int))] >= 0:
        assert line_cost(on, *a, *b) == pytest.approx(expected, rel=1e-9)


def test_a_line_through_the_corner_of_four_pixels_takes_the_cheaper_side():
    state = np.array([[0, 1], [2, 3]], np.int32)
    price = np.full((4, 4), np.inf)
    price[0, 2], price[1, 1] = 1.0, 2.0  # east, south
    across = np.sqrt(2) + 3
    on = ground(np.zeros((2, 2), bool), state, price)
    assert line_cost(on, 0, 0, 1, 1) == pytest.approx(across)
    assert line_cost(on, 1, 1, 0, 0) == np.inf
    price[0, 1], price[2, 2] = 0.5, 1.0
    on = ground(np.zeros((2, 2), bool), state, price)
    assert line_cost(on, 0, 0, 1, 1) == pytest.approx(np.sqrt(2) + 1.5)
    state[1, 0] = -1  # one of the two pixels beside the corner is no floor
    assert line_cost(ground(np.zeros((2, 2), bool), state, price), 0, 0, 1, 1) == np.inf


def test_a_line_is_tight_below_half_a_pixel_more_than_the_radius_and_refused_at_the_radius():
    solid = np.zeros((12, 12), bool)
    solid[0] = True
    on = ground(solid, np.where(solid, -1, 0).astype(np.int32), np.full((1, 4), np.inf))
    assert line_cost(on, 2.5, 1, 2.5, 9) == pytest.approx(8)
    assert line_cost(on, 2.4, 1, 2.4, 9) == pytest.approx(8 * (1 + TIGHT))
    assert line_cost(on, 2.0, 1, 2.0, 9) == np.inf
    assert line_cost(on, 3, 1, 2.4, 9) == pytest.approx(np.hypot(8, 0.6) * (1 + TIGHT))
