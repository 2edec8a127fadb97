"""Masks: run lengths by hand and decoded again, and the label image of a scene."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.core import CloudOrigin, InputError, LabelledCloud
from lifelore.perception.places.object_mask import label_image, object_mask, run_lengths


def decoded(mask: dict) -> np.ndarray:
    """(height, width) bool of a mask in JSON."""
    values = [k % 2 == 1 for k, count in enumerate(mask["counts"]) for _ in range(count)]
    return np.array(values, bool).reshape(mask["size"][::-1]).T


@given(st.integers(0, 10**6), st.integers(1, 7), st.integers(1, 7), st.sampled_from([0.0, 0.3, 0.8, 1.0]))
def test_runs_lead_back_to_the_mask(seed, height, width, share):
    mask = np.random.default_rng(seed).random((height, width)) < share
    counts = run_lengths(mask)
    assert (decoded({"size": list(mask.shape), "counts": counts}) == mask).all()
    assert all(count > 0 for count in counts[1:])


def cloud(rows, grid) -> LabelledCloud:
    """Four points, of the table and of the objects 2 and 5."""
    return LabelledCloud(np.zeros((4, 3)), np.array([1, 2, 5, 2]), origin=CloudOrigin(rows=rows, grid=grid))


def test_an_object_is_at_its_pixels():
    organised = cloud(np.array([0, 5, 2, 3]), (2, 3))
    assert label_image(organised).tolist() == [[1, 0, 5], [2, 0, 2]]
    # Column by column: 0 1 | 0 0 | 0 1
    assert object_mask(organised, 2) == {"mask": {"size": [2, 3], "counts": [1, 1, 3, 1]}}


def test_without_an_image_it_has_the_numbers_of_its_points():
    loose = cloud(np.array([10, 11, 40, 7]), None)
    assert object_mask(loose, 2) == {"points": [11, 7]}
    assert object_mask(cloud(None, None), 2) == {"points": None}
    with pytest.raises(InputError, match=r"not organised.*with_masks"):
        label_image(loose)


def test_a_number_beyond_16_bits_is_refused():
    large = LabelledCloud(
        np.zeros((1, 3)), np.array([70_000]), origin=CloudOrigin(rows=np.array([0]), grid=(1, 1))
    )
    with pytest.raises(InputError, match="up to 65535, got 70000"):
        label_image(large)
