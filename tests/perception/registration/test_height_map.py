"""Height maps by hand."""

import numpy as np

from lifelore.perception.registration.height_map import UNSEEN, cells_spanned, height_map


def test_the_highest_point_of_a_cell_counts() -> None:
    objects = np.array([[0.005, 0.005, 0.05], [0.006, 0.004, 0.08], [0.025, -0.005, 0.03]])
    table = np.array([[0.015, 0.005, 0.002], [0.005, 0.006, 0.001]])
    low, shape = cells_spanned(np.concatenate([objects, table]), 0.01)
    assert (low.tolist(), shape) == ([0, -1], (3, 2))
    found = height_map(objects, table, 0.01, low, shape)
    assert found.heights.tolist() == [[UNSEEN, 0.08], [UNSEEN, 0.0], [0.03, UNSEEN]]
    assert found.objects.tolist() == [[False, True], [False, False], [True, False]]
    assert found.seen.tolist() == [[False, True], [False, True], [True, False]]


def test_what_is_lower_than_the_noise_is_empty() -> None:
    low, shape = cells_spanned(np.zeros((1, 3)), 0.01)
    found = height_map(np.array([[0.0, 0.0, 0.01]]), np.empty((0, 3)), 0.01, low, shape)
    assert found.seen.all()
    assert not found.objects.any()
