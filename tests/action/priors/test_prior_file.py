"""Priors as files: the same bits, the format as documented, and foreign or damaged files refused in one line."""

import io
import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.action.priors.action_prior import ONE, ActionPrior
from lifelore.action.priors.prior_file import FORMAT, load_prior, prior_bytes, prior_from_bytes, save_prior
from lifelore.core.errors import InputError

ABOUT = {"format": FORMAT.name, "version": 1, "n_actions": 2, "alpha0": 0.5, "key": "k", "about": {}}
rows = st.lists(
    st.tuples(st.integers(-(2**60), 2**60), st.lists(st.booleans(), min_size=3, max_size=3)), max_size=9
)


def small() -> ActionPrior:
    prior = ActionPrior(2, alpha0=0.5, key="k")
    prior.update([7, -3], [[True, False], [True, True]], weight=0.25)
    return prior


def packed(about=None, about_text=None, **arrays) -> bytes:
    """The file of `small`, with other parts."""
    text = json.dumps(ABOUT | (about or {})).encode()
    parts = {
        "about": np.frombuffer(text, np.uint8) if about_text is None else about_text,
        "contexts": np.array([-3, 7]),
        "counts": np.array([[ONE // 4, ONE // 4], [ONE // 4, 0]]),
    } | arrays
    stream = io.BytesIO()
    np.savez_compressed(stream, **{name: array for name, array in parts.items() if array is not None})
    return stream.getvalue()


@pytest.mark.slow
@settings(max_examples=25)
@given(rows, st.floats(1e-9, 1e9), st.text())
def test_the_same_bits_come_back(counted, alpha0, key):
    prior = ActionPrior(3, alpha0, key)
    prior.update(
        [code for code, _ in counted], np.array([best for _, best in counted], bool).reshape(-1, 3), 1 / 3
    )
    back = prior_from_bytes(prior_bytes(prior))
    assert (back.n_actions, back.alpha0, back.key) == (3, alpha0, key)
    for one, other in zip(back.fixed_point_counts(), prior.fixed_point_counts(), strict=True):
        assert np.array_equal(one, other)
        assert one.dtype == other.dtype
    assert prior_bytes(back) == prior_bytes(prior)


def test_the_format_as_documented(tmp_path):
    path = tmp_path / "prior.npz"
    save_prior(small(), path, {"actions": ["left", "right"]})
    with np.load(path) as file:
        assert sorted(file.files) == ["about", "contexts", "counts"]
        assert file["contexts"].tolist() == [-3, 7]
        assert (file["counts"] / 2**20).tolist() == [[0.25, 0.25], [0.25, 0.0]]
        told = json.loads(file["about"].tobytes())
    assert told == ABOUT | {"about": {"actions": ["left", "right"]}}
    assert load_prior(path).probs([7]).tolist() == small().probs([7]).tolist()


def test_a_loaded_prior_goes_on_counting():
    prior = prior_from_bytes(packed())
    prior.update([8, 7], [[True, False], [True, False]])
    assert prior.counts([7, 8]).tolist() == [[1.25, 0.0], [1.0, 0.0]]
    prior.merge(small())
    assert prior.counts([-3]).tolist() == [[0.5, 0.5]]


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "no action prior that can be read"),
        (b"Dear diary,", "no action prior that can be read"),
        (packed()[:-40], "no action prior that can be read"),
        (packed({"format": "lifelore relation model"}), "another kind of file"),
        (packed(about_text=np.frombuffer(b"[1]", np.uint8)), "another kind of file"),
        (packed(about_text=np.frombuffer(b"{", np.uint8)), "no action prior that can be read"),
        (packed(contexts=None), "contexts"),
        (packed(counts=None), "counts"),
        (packed({"n_actions": 3}), r"counts must have shape \(2, 3\), got \(2, 2\)"),
        (packed({"n_actions": "2"}), "must be a whole number"),
        (packed({"alpha0": -1.0}), "alpha0 must be positive"),
        (packed({"alpha0": None}), "must be a whole number, a number and a text"),
        (packed(contexts=np.array([7, -3])), "contexts must be distinct and ascending"),
        (packed(contexts=np.array([7, 7])), "contexts must be distinct and ascending"),
        (packed(contexts=np.array([-3.0, 7.0])), "must be int64, got float64"),
        (packed(contexts=np.array([-3, 2**62])), "magnitude at most"),
        (packed(counts=np.array([[1, 1], [0, 0]])), "with a positive one in each row"),
        (packed(counts=np.array([[1, 1], [1, -1]])), "counts must be at least 0"),
        (packed(counts=np.array([[{}, 1], [1, 1]], object)), "no action prior that can be read"),
    ],
)  # fmt: skip
def test_foreign_and_damaged_files_are_refused_in_one_line(tmp_path, content, reason):
    path = tmp_path / "prior.npz"
    path.write_bytes(content)
    with pytest.raises(InputError, match=reason) as refused:
        load_prior(path)
    assert str(refused.value).startswith(str(path))
    assert "\n" not in str(refused.value)
