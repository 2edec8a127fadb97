"""The library: from samples, means and tables; names, priors; types and policies that come and go."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction import CategorySignal, PolicyLibrary, ReturnSignal

MEAN = [[10.0, 0.0], [0.0, 8.0], [4.0, 5.0]]


def library(**options):
    return PolicyLibrary.from_means(MEAN, 2.0, **options)


def test_defaults():
    made = library()
    assert (made.n_types, made.n_policies) == (3, 2)
    assert made.types == ("type 0", "type 1", "type 2")
    assert made.policies == ("policy 0", "policy 1")
    np.testing.assert_allclose(made.prior, 1 / 3)
    assert isinstance(made.signal, ReturnSignal)
    assert made.signal.outcomes is made.performance


COLUMNS = {
    "type": ["young", "old", "young", "old", "young"],
    "policy": ["A", "A", "B", "B", "A"],
    "outcome": [1.0, 2.0, 3.0, 4.0, 5.0],
}


def test_from_columns_by_hand():
    made = PolicyLibrary.from_frame(COLUMNS)
    assert made.types == ("young", "old")
    assert made.policies == ("A", "B")
    np.testing.assert_allclose(made.performance.mean, [[3.0, 3.0], [2.0, 4.0]])
    renamed = {"who": COLUMNS["type"], "what": COLUMNS["policy"], "paid": COLUMNS["outcome"]}
    other = PolicyLibrary.from_frame(renamed, type="who", policy="what", outcome="paid", shrinkage=2.0)
    np.testing.assert_allclose(other.performance.mean, made.performance.mean)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"outcome": [1.0, 2.0, np.nan, 4.0, 5.0]}, "row 2 is nan"),
        ({"outcome": [1.0, 2.0]}, "one length"),
        ({"outcome": ["x"] * 5}, "must hold numbers"),
        ({"type": ["a", "a", "a", "a", "b"]}, "type 1 with policy 1"),
        ({"type": [], "policy": [], "outcome": []}, "at least 1"),
    ],
)
def test_tables_that_cannot_be_used_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        PolicyLibrary.from_frame(COLUMNS | change)


@pytest.mark.parametrize(
    "prior",
    [[0.5, 0.5, 0.1], [1.5, -0.5, 0.0], [np.nan, 0.5, 0.5], [0.5, 0.5], [np.inf, 0, 0], [1 / 3 + 1e-8] * 3],
)
def test_priors_that_are_none_are_refused(prior):
    with pytest.raises(InputError, match="prior must be"):
        library(prior=prior)


def test_names_must_be_distinct_and_enough():
    with pytest.raises(InputError, match="3 distinct names of type"):
        library(types=["a", "b"])
    with pytest.raises(InputError, match="2 distinct names of policy"):
        library(policies=["a", "a"])


def test_policies_are_found_by_name_and_number():
    made = library(policies=["left", "right"])
    assert made.index_of_policy("right") == made.index_of_policy(1) == made.index_of_policy(np.int64(1)) == 1
    assert made.index_of_type("type 2") == 2
    for unknown in ("up", 2, -1, None, 0.0):
        with pytest.raises(NotFoundError, match="unknown policy"):
            made.index_of_policy(unknown)


def test_signal_and_performance_must_be_of_one_size():
    coin = CategorySignal(np.full((2, 2, 2), 0.5))
    with pytest.raises(InputError, match="signal has n_types 2, performance has 3"):
        library(signal=coin)
    with pytest.raises(InputError, match="signal has n_policies"):
        library(signal=CategorySignal(np.full((3, 1, 2), 0.5)))


def test_a_type_and_a_policy_later():
    made = library(prior=[0.6, 0.4, 0.0])
    grown = made.with_type([[1.0, 2.0], [3.0, 4.0]], "late", mass=0.1)
    assert grown.types[-1] == "late"
    np.testing.assert_allclose(grown.prior, [0.54, 0.36, 0.0, 0.1])
    assert grown.signal.log_likelihood(0, 1.0).shape == (4,)
    assert grown.with_type([[1.0], [2.0]]).types[-1] == "type 4"
    wider = made.with_policy([[1.0], [2.0], [3.0]])
    assert wider.policies[-1] == "policy 2"
    np.testing.assert_array_equal(wider.prior, made.prior)
    assert made.n_policies == 2
    with pytest.raises(InputError, match=r"mass must lie in \[0, 1\)"):
        made.with_type([[1.0], [2.0]], mass=1.0)
    with pytest.raises(InputError, match="distinct names"):
        made.with_type([[1.0], [2.0]], "type 0")


def test_a_policy_retires():
    made = library(policies=["left", "right"]).without_policy("left")
    assert made.policies == ("right",)
    np.testing.assert_array_equal(made.performance.mean, np.array(MEAN)[:, [1]])
    assert made.signal.outcomes is made.performance
    with pytest.raises(InputError, match="the chosen numbers must be"):
        made.without_policy("right")
    with pytest.raises(InputError, match="the chosen numbers must be"):
        library().take([0.7])  # pyright: ignore[reportArgumentType]
    with pytest.raises(NotFoundError):
        made.without_policy("left")


def test_other_signals_are_cut_down_or_asked_for():
    coin = CategorySignal(np.random.default_rng(0).dirichlet([1, 1], (3, 2)))
    made = library(signal=coin)
    cut = made.without_policy(0)
    np.testing.assert_array_equal(cut.signal.log_likelihood(0, 1), coin.log_likelihood(1, 1))
    with pytest.raises(InputError, match="give the new library's signal model"):
        made.with_type([[1.0], [2.0]])
    given = made.with_type([[1.0], [2.0]], signal=CategorySignal(np.full((4, 2, 2), 0.5)))
    assert given.n_types == 4

    class Own:
        def log_likelihood(self, policy, signal):
            return np.zeros(3)

    with pytest.raises(InputError, match="Own cannot be restricted"):
        library(signal=Own()).without_policy(0)


def test_some_types_share_the_prior_anew():
    some = library(prior=[0.5, 0.3, 0.2]).take(types=[2, 1])
    np.testing.assert_allclose(some.prior, [0.4, 0.6])
    assert some.types == ("type 2", "type 1")
    with pytest.raises(InputError, match="no prior mass"):
        library(prior=[1.0, 0.0, 0.0]).take(types=[1, 2])
