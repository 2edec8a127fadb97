"""O9: baselines and measures by hand."""

import numpy as np
import pytest

from lifelore.domains.grids.grid_world import GridWorld
from reproduction.engine.registry import claim_of
from reproduction.own.o_09_travel_times.run import BINS, Baselines, _by_bin, _shortest_way


def test_baselines_by_hand():
    seen = Baselines(5)
    seen.observe(np.array([1, 2, 1]), np.array([3.0, 2.0, 4.0]))
    seen.observe(np.array([1, 3]), np.array([8.0, np.nan]))
    last, mean = seen.expected(np.array([1, 2, 3]))
    assert last.tolist() == [8, 2, 17 / 4]  # move 3 was never passed: the mean of all passes
    assert mean.tolist() == [5, 2, 17 / 4]


def test_a_way_leads_round_a_refused_cell():
    world = GridWorld.from_free("building", np.ones((2, 3), np.bool_))
    every = np.ones(6, np.bool_)
    assert np.asarray(_shortest_way(world, every, 0, 2)).tolist() == [0, 1, 2]
    round_it = _shortest_way(world, every & (np.arange(6) != 1), 0, 2)
    assert np.asarray(round_it).tolist() == [0, 3, 4, 5, 2]
    assert _shortest_way(world, np.isin(np.arange(6), [0, 2, 3]), 0, 2) is None
    assert _shortest_way(world, every, 2, 2) is None


def test_measures_by_hand():
    bins = _by_bin(np.array([0.01, 0.3, 0.9, 1.0]), np.array([False, False, True, True]))
    assert bins.shape == (len(BINS) - 1, 3)
    assert bins.sum(axis=0) == pytest.approx([4, 2.21, 2])
    life = {
        "seconds": [0.3, 0.6, 0.5, 0.2],
        "logarithms": [0.1] * 4,
        "ways": [5, 4, 6, 3],
        "bins": bins,
        "squared": 0.05,
    }
    other = life | {"seconds": [0.4, 0.8, 1.0, 0.2]}
    found, _ = claim_of("O9").measured({}, [life, other])
    assert found["moves_to_better"].value == pytest.approx(0.7 / 1.3)
    assert found["ways_to_better"].value == pytest.approx(5 / 4)
    assert found["squared_to_share"].value == pytest.approx(0.05 / 0.25)
    assert found["likely_refused"].value == pytest.approx(2 / 3)
    assert found["likely_gap"].value == pytest.approx((2.2 - 2) / 3)
