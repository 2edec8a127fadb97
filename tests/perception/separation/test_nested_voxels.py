"""Voxels in voxels: every point is in one of each level, and their weights and centroids add up."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.perception.separation.nested_voxels import COARSEST, FINEST, voxel_pyramid


def dense_pair(seed, n=2000, scale=1.0):
    random = np.random.default_rng(seed)
    points = random.uniform(0, scale, (3, n))
    return points, np.where(random.random(n) < 0.4, 1.0, -1.0)


@given(st.integers(0, 10**6), st.sampled_from([0.0, 0.3, 2.0, 1e4, 1e9]))
@settings(max_examples=30, deadline=None)
def test_levels_nest(seed, scale):
    points, side = dense_pair(seed, 300, scale)
    result = voxel_pyramid(points, side, 0.5)
    assert np.array_equal(np.sort(result.order), np.arange(300))
    finest = result.levels[-1]
    assert np.array_equal(finest.points, points[:, result.order])
    assert np.array_equal(finest.side, side[result.order])
    for coarse, fine in zip(result.levels, result.levels[1:], strict=False):
        assert coarse.starts[0] == 0
        assert coarse.starts[-1] == len(fine.side)
        assert 3 * len(coarse.side) <= len(fine.side)
        for i, side_here in enumerate(coarse.side):
            own = slice(coarse.starts[i], coarse.starts[i + 1])
            assert (fine.side[own] == side_here).all()
            assert fine.cap[own].sum() == pytest.approx(coarse.cap[i])
            centre = fine.points[:, own] @ fine.cap[own] / coarse.cap[i]
            assert centre == pytest.approx(coarse.points[:, i], abs=1e-12 + 1e-12 * scale)
            if scale <= 1e4:
                assert np.ptp(fine.points[:, own], axis=1).max() <= coarse.edge * (1 + 1e-9)


def test_dense_clouds_get_every_level():
    points, side = dense_pair(0, 60_000, 0.5)
    levels = voxel_pyramid(points, side, 1.0).levels
    assert [level.edge for level in levels] == [FINEST * 2**k for k in range(COARSEST, -1, -1)] + [0.0]


def test_points_that_are_alone_get_none():
    points, side = dense_pair(0, 50, 100.0)
    assert len(voxel_pyramid(points, side, 1.0).levels) == 1


def test_both_ways_of_sorting_agree(monkeypatch):
    from lifelore.perception.separation import nested_voxels

    key = np.random.default_rng(0).integers(0, 40, 500)
    fast = nested_voxels._sorted(key, 6)
    slow = nested_voxels._sorted(key, 60)
    assert all(np.array_equal(a, b) for a, b in zip(fast, slow, strict=True))
    assert np.array_equal(fast[1], np.sort(key))
