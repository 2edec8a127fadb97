"""Labels never overlap where there is room, stay inside, and on their own object if it is seen."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.figures.label_placement import place_labels


@given(n=st.integers(1, 15), seed=st.integers(0, 200))
@settings(deadline=None, max_examples=40)
def test_labels_are_apart_and_inside(n, seed):
    anchors = np.random.default_rng(seed).uniform([150, 120], [250, 180], (n, 2))
    sizes = np.tile([24.0, 16.0], (n, 1))
    at = place_labels(anchors, sizes, (400, 300))
    for i in range(n):
        for j in range(i):
            assert (np.abs(at[i] - at[j]) >= (sizes[i] + sizes[j]) / 2).any()
    assert (at >= sizes / 2).all()
    assert (at <= [400, 300] - sizes / 2).all()


def test_a_label_is_put_on_its_own_object():
    grounds = np.full((100, 100), -1)
    grounds[80:95, 80:95] = 7
    x, y = place_labels([[30, 30]], [[10, 10]], (100, 100), grounds=grounds, owners=[7])[0].astype(int)
    assert grounds[y, x] == 7
