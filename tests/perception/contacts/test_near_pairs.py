"""Near pairs against all pairs of points; the table that is near whatever hides the foot."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.clouds.cell_cloud import cell_cloud, closest_distances
from lifelore.perception.contacts.near_pairs import (
    CLOSEST,
    ObjectCloud,
    box_distance,
    near_pairs,
    split_objects,
    visible_gap,
)


def naive_closest(first: np.ndarray, second: np.ndarray, count: int, bound: float) -> np.ndarray:
    nearest = np.sort(cdist(first, second).min(axis=1))[:count]
    return nearest[nearest <= bound]


@settings(deadline=None, max_examples=60)
@given(st.integers(1, 80), st.integers(1, 80), st.integers(0, 2**32), st.floats(0.0, 0.5), st.floats(0.01, 0.3))
def test_closest_distances_are_those_of_all_pairs(n, m, seed, apart, bound):
    rng = np.random.default_rng(seed)
    first, second = rng.random((n, 3)) * 0.2, rng.random((m, 3)) * 0.2 + [apart, 0, 0]
    found = closest_distances(cell_cloud(first), cell_cloud(second), 5, bound)
    np.testing.assert_allclose(found, naive_closest(first, second, 5, bound), rtol=0, atol=1e-12)


def grid(low, high, step=0.01) -> np.ndarray:
    axes = [np.arange(a, b + step / 2, step) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def test_gap_of_two_blocks_is_their_distance_and_one_stray_point_moves_it_by_a_fifth():
    a, b = grid((0, 0, 0), (0.05, 0.05, 0.05)), grid((0.08, 0, 0), (0.12, 0.05, 0.05))
    assert np.isclose(visible_gap(ObjectCloud(2, a), ObjectCloud(3, b), 0.1), 0.03)
    stray = np.vstack([a, [0.075, 0.02, 0.02]])
    gap = visible_gap(ObjectCloud(2, stray), ObjectCloud(3, b), 0.1)
    assert np.isclose(gap, (0.005 + (CLOSEST - 1) * 0.03) / CLOSEST)
    assert np.isinf(visible_gap(ObjectCloud(2, a), ObjectCloud(3, b), 0.02))


@settings(deadline=None, max_examples=40)
@given(st.integers(1, 40), st.integers(1, 40), st.integers(0, 2**32))
def test_the_gap_is_the_larger_mean_of_both_directions_in_either_order(n, m, seed):
    rng = np.random.default_rng(seed)
    first, second = rng.random((n, 3)) * 0.1, rng.random((m, 3)) * 0.1 + [0.08, 0, 0]
    means = [naive_closest(a, b, CLOSEST, 0.3).mean() for a, b in ((first, second), (second, first))]
    a, b = ObjectCloud(2, first), ObjectCloud(3, second)
    assert np.isclose(visible_gap(a, b, 0.3), max(means), rtol=0, atol=1e-12)
    assert visible_gap(a, b, 0.3) == visible_gap(b, a, 0.3)


def test_box_distance_is_pythagoras_between_corners():
    a = ObjectCloud(2, np.array([[0.0, 0, 0], [1, 1, 1]]))
    b = ObjectCloud(3, np.array([[4.0, 5, 0.5], [6, 6, 2]]))
    assert np.isclose(box_distance(a, b), 5.0)
    assert box_distance(a, a) == 0.0


def test_pairs_come_in_order_and_far_ones_not_at_all():
    blocks = {5: 0.0, 3: 0.10, 2: 0.40}
    points = [grid((x, 0, 0.0), (x + 0.05, 0.05, 0.05)) for x in blocks.values()]
    table = grid((-0.2, -0.2, 0), (0.7, 0.3, 0))
    labels = np.repeat([*blocks, TABLE], [*map(len, points), len(table)])
    cloud = LabelledCloud(np.vstack([*points, table]), labels)
    pairs = near_pairs(split_objects(cloud), 0.08, 0.04)
    assert [(p.first.label, p.second.label) for p in pairs] == [(3, 5), (2, TABLE), (3, TABLE), (5, TABLE)]
    around = pairs[-1].second.points
    assert around[:, 0].min() >= -0.04 - 1e-9
    assert around[:, 0].max() <= 0.09 + 1e-9


def test_the_table_is_near_even_where_none_of_it_is_seen_under_an_object():
    block = grid((0, 0, 0.2), (0.05, 0.05, 0.25))
    table = grid((0.5, 0, 0), (0.8, 0.3, 0))
    cloud = LabelledCloud(np.vstack([block, table]), np.repeat([2, TABLE], [len(block), len(table)]))
    (pair,) = near_pairs(split_objects(cloud), 0.08, 0.04)
    assert np.isclose(pair.gap, np.hypot(0.45, 0.2), atol=1e-3)
