"""Feature sets: codes by hand, round trips, coarser codes, limits."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.action.features.feature_set import FeatureSet
from lifelore.core.errors import InputError

sets = st.lists(st.integers(1, 5), min_size=0, max_size=6)


def named(sizes) -> FeatureSet:
    return FeatureSet(tuple(f"f{i}" for i in range(len(sizes))), tuple(sizes))


@st.composite
def rows(draw):
    sizes = draw(sets)
    row = st.tuples(*(st.integers(0, size - 1) for size in sizes))
    found = draw(st.lists(row, max_size=6))
    return named(sizes), np.array(found, np.int64).reshape(len(found), len(sizes))


def test_codes_by_hand():
    # φ4 of the modified factory: nine terrains of four kinds and a flag of three values (§3.4.5).
    features = FeatureSet((*(f"t{i}" for i in range(9)), "items"), (4,) * 9 + (3,))
    assert features.n_codes == 4**9 * 3 == 786_432
    assert 1 - 4**4 / features.n_codes == pytest.approx(0.999674, abs=1e-6)  # reduced to φ1 (§3.4.6)
    assert features.codes([[0] * 10, [0] * 8 + [1, 2], [3] * 9 + [2]]).tolist() == [0, 5, 786_431]


@settings(max_examples=25)
@given(rows())
def test_codes_lead_back_to_the_columns(case):
    features, columns = case
    codes = features.codes(columns)
    assert np.array_equal(features.columns(codes), columns)
    assert ((codes >= 0) & (codes < features.n_codes)).all()


@pytest.mark.slow
@settings(max_examples=25)
@given(rows(), st.randoms(use_true_random=False))
def test_coarser_codes_are_the_codes_of_fewer_columns(case, random):
    features, columns = case
    kept = sorted(random.sample(range(len(features)), random.randint(0, len(features))))
    names = [features.names[i] for i in kept]
    random.shuffle(names)  # the order asked in does not matter
    expected = features.subset(names).codes(columns[:, kept])
    assert np.array_equal(features.coarser(features.codes(columns), names), expected)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: FeatureSet(("a", "a"), (2, 2)), "must be distinct and not empty, got a, a"),
        (lambda: FeatureSet(("",), (2,)), "must be distinct and not empty"),
        (lambda: FeatureSet(("a",), (0,)), r"sizes of features must be at least 1, got \[0\]"),
        (lambda: FeatureSet(("a",), (1, 2)), "each feature needs a size, got 1 names and 2 sizes"),
        (lambda: named((2, 3)).codes([[0, 3]]), r"feature 'f1' must lie in \[0, 3\), got 3..3"),
        (lambda: named((2, 3)).codes([[-1, 0]]), "feature 'f0' must lie in"),
        (lambda: named((2, 3)).codes([[0.5, 1.0]]), "must be whole numbers, got float64"),
        (lambda: named((2, 3)).codes([[0]]), r"columns must have shape \(n, 2\), got \(1, 1\)"),
        (lambda: named((2, 3)).columns([6]), r"codes must lie in \[0, 6\), got 6..6"),
        (lambda: named((2, 3)).coarser([-1], ["f0"]), "codes must lie in"),
    ],
)
def test_broken_rules(call, message):
    with pytest.raises(InputError, match=message):
        call()
