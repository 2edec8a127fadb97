"""Libraries on disk: the same bits back, equal bytes for equal libraries, clear words for other files."""

import io
import json

import numpy as np
import pytest

from lifelore.core.errors import InputError, StoreError
from lifelore.interaction import LikelihoodSignal, PolicyLibrary
from lifelore.interaction.outcomes.outcome_kinds import KINDS

from ..reuse.families import FAMILIES

SAMPLES = np.random.default_rng(0).integers(0, 5, (2, 2, 4)).astype(float)


def same(first, second, signal):
    assert (first.types, first.policies) == (second.types, second.policies)
    np.testing.assert_array_equal(first.prior, second.prior)
    for value in (0.0, 2.0, 3.0):
        np.testing.assert_array_equal(
            first.performance.log_density(1, value), second.performance.log_density(1, value)
        )
    np.testing.assert_array_equal(first.signal.log_likelihood(1, signal), second.signal.log_likelihood(1, signal))


@pytest.mark.parametrize("model", sorted(KINDS))
def test_every_performance_model_comes_back(model, tmp_path):
    library = PolicyLibrary.from_samples(SAMPLES, ["ä", "b"], ["π", "q"], model, prior=[0.1, 0.9])
    library.observe(0, 1, 3.0)
    library.save(tmp_path / "library.npz")
    again = PolicyLibrary.load(tmp_path / "library.npz")
    same(library, again, 2.0)
    np.testing.assert_array_equal(library.table().probs, again.table().probs)
    assert again.signal.outcomes is again.performance
    for made in (library, again):
        made.observe(1, 0, 1.0)
    same(library, again, 2.0)
    assert library.to_bytes() == again.to_bytes()


@pytest.mark.parametrize("name", sorted(set(FAMILIES) - {"own"}))
def test_every_signal_model_comes_back(name):
    library, signal = FAMILIES[name].library(), FAMILIES[name].draw(np.random.default_rng(0))
    again = PolicyLibrary.from_bytes(library.to_bytes())
    assert type(again.signal) is type(library.signal)
    same(library, again, signal)
    with pytest.raises(InputError):
        again.signal.log_likelihood(1, "no signal")


def test_an_own_signal_model_is_given_again(tmp_path):
    own = LikelihoodSignal(lambda policy, signal: [signal, 0.0], 2)
    path = tmp_path / "library.npz"
    PolicyLibrary.from_samples(SAMPLES, signal=own).save(path)
    with pytest.raises(InputError, match=r"its owner \(LikelihoodSignal\); give the model as signal="):
        PolicyLibrary.load(path)
    assert PolicyLibrary.load(path, signal=own).signal is own


def test_files_that_are_none_are_refused(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        PolicyLibrary.load(tmp_path / "nothing.npz")
    library = PolicyLibrary.from_samples(SAMPLES)
    with pytest.raises(StoreError, match="cannot be written"):
        library.save(tmp_path / "no" / "such" / "folder.npz")
    good = library.to_bytes()
    for content in (b"", b"no zip", good[:200], good[: len(good) // 2]):
        with pytest.raises(InputError, match="no policy library that can be read"):
            PolicyLibrary.from_bytes(content)


def changed(library, **arrays):
    """The file with some arrays replaced, or left out where None."""
    with np.load(io.BytesIO(library.to_bytes())) as packed:
        held = {name: packed[name] for name in packed.files} | arrays
    stream = io.BytesIO()
    np.savez(stream, **{name: value for name, value in held.items() if value is not None})
    return stream.getvalue()


def header(library, **changes):
    with np.load(io.BytesIO(library.to_bytes())) as packed:
        text = json.dumps(json.loads(packed["about"].tobytes()) | changes)
    return np.frombuffer(text.encode(), np.uint8)


def test_damage_is_told():
    library = PolicyLibrary.from_samples(SAMPLES)
    nested = {"kind": "joint", "parts": []}
    for _ in range(20):
        nested = {"kind": "joint", "parts": [nested]}
    for arrays in [
        {"prior": np.array([0.5, 0.6])},
        {"prior": None},
        {"performance.mean": np.full((2, 2), np.nan)},
        {"performance.mean": None},
        {"performance.variance": np.zeros((2, 2))},
        {"performance.mean": np.array([["x"]])},
        {"about": header(library, performance="unheard")},
        {"about": header(library, signal={"kind": "unheard"})},
        {"about": header(library, signal=nested)},
        {"about": header(library, signal=[])},
        {"about": header(library, types=["a"])},
        {"about": header(library, format="something else")},
        {"about": np.array([1, 2, 3], np.uint8)},
        {"prior": np.array([{}], object)},
    ]:
        with pytest.raises(InputError, match="no policy library that can be read"):
            PolicyLibrary.from_bytes(changed(library, **arrays))
    with pytest.raises(InputError, match="has version 99, this Lifelore reads 1"):
        PolicyLibrary.from_bytes(changed(library, about=header(library, version=99)))


def test_a_model_of_the_callers_cannot_be_written():
    library = PolicyLibrary.from_samples(SAMPLES)

    class Own:
        n_types = n_policies = 2

    library.performance = Own()
    with pytest.raises(InputError, match="performance must be one of"):
        library.to_bytes()
