"""Learnt contexts: the nearest centre by hand, separate situations apart, deterministic, saved and read."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.action.features.learnt_contexts import LearntContexts
from lifelore.core.errors import InputError

CORNERS = np.array([[0, 0], [0, 1], [1, 0], [1, 1]], float)


def situations(n=50, spread=0.05, units=(1.0, 1000.0)):
    """Observations near the corners of a square whose sides have different units, and their corners."""
    random = np.random.default_rng(2)
    corner = random.integers(4, size=n)
    return (CORNERS[corner] + random.normal(0, spread, (n, 2))) * units, corner


def test_each_situation_has_a_code_of_its_own_whatever_the_units():
    seen, corner = situations()
    contexts = LearntContexts.fit(seen, n_codes=4)
    pairs = {(int(where), contexts(one)) for where, one in zip(corner, seen, strict=True)}
    assert len(pairs) == len({code for _, code in pairs}) == 4


@given(st.lists(st.floats(-3, 3, width=32), min_size=6, max_size=6))
def test_the_code_is_the_nearest_centre(numbers):
    """The naive twin: distances in units of the scale. Equal distances, up to rounding, may go either way."""
    centres = np.random.default_rng(4).normal(size=(7, 6)).astype(np.float32)
    shift, scale = np.arange(6, dtype=np.float32), np.array([1, 2, 3, 1, 2, 3], np.float32)
    code = LearntContexts(centres, shift, scale)(np.reshape(numbers, (2, 3)))
    distances = np.linalg.norm(centres - (np.array(numbers) - shift) / scale, axis=1)
    assert distances[code] <= distances.min() + 1e-4


def test_the_same_seed_gives_the_same_centres_and_key():
    images = np.random.default_rng(0).integers(0, 256, (60, 4, 4, 3), np.uint8)
    one, again = (LearntContexts.fit(images, n_codes=5, seed=3) for _ in range(2))
    other = LearntContexts.fit(images, n_codes=5, seed=4)
    assert one.key == again.key != other.key
    assert np.array_equal(one.centres, again.centres)
    assert set(one.scale.tolist()) == {255.0}


def test_a_file_gives_the_same_bits(tmp_path):
    contexts = LearntContexts.fit(situations()[0], n_codes=3)
    contexts.save(tmp_path / "codes.npz")
    assert LearntContexts.load(tmp_path / "codes.npz").key == contexts.key
    (tmp_path / "codes.npz").write_bytes(b"no archive")
    for name in ("codes.npz", "none.npz"):
        with pytest.raises(InputError, match=name):
            LearntContexts.load(tmp_path / name)


@pytest.mark.parametrize(
    ("observations", "settings", "message"),
    [
        ([[1.0], [2.0]], {"n_codes": 3}, r"n_codes must lie in \[1, 2\]"),
        ([[1.0], [np.nan]], {"n_codes": 1}, "must be finite"),
        ([[1.0], [2.0, 3.0]], {"n_codes": 1}, "numbers of one shape"),
    ],
)
def test_wrong_observations(observations, settings, message):
    with pytest.raises(InputError, match=message):
        LearntContexts.fit(observations, **settings)
