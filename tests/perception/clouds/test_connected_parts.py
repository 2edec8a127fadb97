"""Connected parts beside a plain search, and pixels worked by hand."""

import numpy as np

from lifelore.perception.clouds.connected_parts import connected_parts
from lifelore.perception.clouds.view_image import view_pixels


def plain_parts(pairs, n):
    """The smallest member of each item's part, found by passing it on until nothing changes."""
    smallest = list(range(n))
    changed = True
    while changed:
        changed = False
        for a, b in pairs:
            low = min(smallest[a], smallest[b])
            changed |= smallest[a] != low or smallest[b] != low
            smallest[a] = smallest[b] = low
    return smallest


def test_parts_are_those_of_a_plain_search():
    rng = np.random.default_rng(0)
    for n in (1, 7, 40):
        pairs = rng.integers(0, n, (n // 2, 2))
        found = connected_parts(pairs, n)
        plain = np.unique(plain_parts(pairs.tolist(), n), return_inverse=True)[1]
        assert len(np.unique(np.stack([found, plain], axis=1), axis=0)) == found.max() + 1 == plain.max() + 1


def test_without_a_pair_each_item_is_a_part():
    assert sorted(connected_parts(np.empty((0, 2), np.int64), 3).tolist()) == [0, 1, 2]


def test_pixels_of_rays_by_hand():
    rays = np.array([[1.0, 0.005, 0.005], [10.0, 0.05, 0.05], [1.0, -0.005, 0.015], [0.0, 1.0, 0.0]])
    assert view_pixels(rays, 0.01).T.tolist() == [[0, 0], [0, 0], [-1, 1], [157, 0]]
