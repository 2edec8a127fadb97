"""Types that change: by hand, in log space, and what they are for."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.belief import log_prior
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics

from ..twins import naive_reuse as naive

INF = np.inf


@settings(deadline=None, max_examples=100)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.002, 0.3, 1.0, 1e-12, 1e-295]))
def test_steps_agree_with_the_slow_twin(seed, rate):
    """Beliefs and priors with zeros, beliefs below the range of numbers, rates too small for a float32."""
    random = np.random.default_rng(seed)
    prior = random.dirichlet(np.full(5, 0.2))
    prior[random.random(5) < 0.2] = 0
    prior = prior / prior.sum() if prior.sum() else np.full(5, 0.2)
    rows = random.normal(scale=10.0 ** random.integers(4), size=(3, 5))
    rows[:, 1:][random.random((3, 4)) < 0.3] = -INF
    rows = np.array([naive.normalised(row) for row in rows])
    matrix = random.dirichlet(np.full(5, 0.3), 5)
    for dynamics, step in (
        (TypeDynamics.hazard(rate, prior), naive.hazard(rate, (prior / prior.sum()).tolist())),
        (
            TypeDynamics.transitions(matrix),
            naive.transitions((matrix / matrix.sum(axis=1, keepdims=True)).tolist()),
        ),
    ):
        expected = np.array([step(row) for row in rows.tolist()])
        np.testing.assert_allclose(dynamics.step(rows), expected, rtol=1e-12, atol=1e-12)
        single = dynamics.step(rows.astype(np.float32))
        assert single.dtype == np.float32 or dynamics.kind == "transitions"
        np.testing.assert_allclose(single, expected, rtol=1e-5, atol=1e-5)


def test_the_probability_that_a_type_has_just_changed():
    """Of a type's belief after the step, the part that was drawn anew; by hand."""
    changing = TypeDynamics.hazard(0.2, [0.5, 0.5, 0.0])
    after = changing.step(log_prior([0.9, 0.1, 0.0]))
    assert np.exp(after) == pytest.approx([0.82, 0.18, 0.0])
    share = changing.changed_share(after)
    assert share[:2] == pytest.approx([0.1 / 0.82, 0.1 / 0.18])
    assert TypeDynamics.static().changed_share(after) is None
    assert TypeDynamics.hazard(0.0, [0.5, 0.5]).changed_share(after[:2]) is None
    assert TypeDynamics.transitions(np.eye(3)).changed_share(after) is None


def test_transitions_keep_what_lies_below_the_range_of_numbers():
    swap = TypeDynamics.transitions([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    moved = swap.step(np.array([0.0, -5000.0, -INF]))
    assert moved.tolist() == [-5000.0, 0.0, -INF]


def test_bad_dynamics_are_refused():
    with pytest.raises(InputError, match=r"rate must lie in \[0, 1\], got 1.5"):
        TypeDynamics.hazard(1.5, [0.5, 0.5])
    with pytest.raises(InputError, match="prior must sum to 1"):
        TypeDynamics.hazard(0.1, [0.5, 0.6])
    with pytest.raises(InputError, match="got shape"):
        TypeDynamics.transitions([[0.5, 0.5]])
    with pytest.raises(InputError, match="rows of probabilities"):
        TypeDynamics.transitions([[0.5, 0.5], [0.9, 0.9]])
    half = np.array([0.5, 0.5])
    for made in (
        ("sometimes", 0.1, half),
        ("static", 0.0, half),
        ("hazard", 0.1, None),
        ("hazard", np.nan, half),
        ("transitions", 0.0, half),
        ("transitions", 0.0, np.eye(3)[:2]),
    ):
        with pytest.raises(InputError, match="no dynamics of kind"):
            TypeDynamics(*made)  # pyright: ignore[reportArgumentType]
    with pytest.raises(InputError, match="law must be probabilities"):
        TypeDynamics("hazard", 0.1, np.array([0.5, np.nan]))
    with pytest.raises(InputError, match="law must be probabilities"):
        TypeDynamics("hazard", 0.1, np.array([1.5, -0.5]))


def test_a_certain_type_is_never_more_than_certain():
    rates = np.linspace(0, 1, 101)
    sure = log_prior([1.0])
    # What the step is made of rounds to more than 0 for some of them.
    with np.errstate(divide="ignore"):
        assert (np.logaddexp(np.log1p(-rates), np.log(rates)) > 0).any()
    assert all(TypeDynamics.hazard(rate, [1.0]).step(sure)[0] <= 0 for rate in rates)
    absorbing = TypeDynamics.transitions(np.eye(3)[[0, 0, 0]])
    beliefs = log_prior(np.random.default_rng(0).dirichlet(np.ones(3), 300))
    assert (absorbing.step(beliefs) <= 0).all()
