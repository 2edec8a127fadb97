"""Every outcome model: the shapes and laws they share, against integration, naive loops and draws."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import integrate

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.outcome_kinds import KINDS, outcome_kind
from lifelore.interaction.outcomes.spread import Spread

SHAPE = (3, 2)


def samples(n=6):
    """Whole numbers, so that every model can take them: three types, two policies."""
    means = np.array([[0, 4], [3, 3], [8, -2]])
    return means[..., None] + np.random.default_rng(1).integers(-3, 4, (*SHAPE, n)).astype(float)


def models():
    return {name: kind.from_samples(samples()) for name, kind in KINDS.items()}


every_model = pytest.mark.parametrize("name", sorted(KINDS))
continuous = pytest.mark.parametrize("name", sorted(set(KINDS) - {"categorical"}))


def test_all_four_are_registered():
    assert set(KINDS) == {"gaussian", "student-t", "histogram", "categorical"}
    assert outcome_kind("gaussian") is GaussianOutcomes
    with pytest.raises(InputError, match="model must be one of"):
        outcome_kind("uniform")


@every_model
def test_sizes_and_shapes(name):
    model = models()[name]
    assert (model.n_types, model.n_policies) == SHAPE
    for found in (
        model.mean,
        model.deviation,
        model.density(1.0),
        model.exceedance(1.0),
        model.expected_excess(1.0),
        model.expected_mean_excess(1.0),
    ):
        assert found.shape == SHAPE
    batch = np.array([[0.0, 1.0, 2.5, 3.0], [-1.0, 0.5, 9.0, 2.0]])
    for query in (model.density, model.exceedance, model.expected_excess, model.expected_mean_excess):
        found = query(batch)
        assert found.shape == (2, 4, *SHAPE)
        for place in np.ndindex(batch.shape):
            np.testing.assert_allclose(found[place], query(float(batch[place])), rtol=1e-12, atol=1e-15)
    assert model.log_density(1, 1.0).shape == (3,)
    assert model.cumulative(0, np.arange(4.0)).shape == (3, 4)


@every_model
def test_log_density_is_the_densitys_logarithm(name):
    model = models()[name]
    for value in (-40.0, -3.0, 0.0, 3.0, 7.0):
        with np.errstate(divide="ignore"):
            expected = np.log(model.density(value))
        for policy in range(2):
            np.testing.assert_allclose(model.log_density(policy, value), expected[:, policy], rtol=1e-10)
    many = model.log_densities(np.array([0, 1, 0]), np.array([3.0, 0.0, -40.0]))
    one_by_one = [model.log_density(0, 3.0), model.log_density(1, 0.0), model.log_density(0, -40.0)]
    np.testing.assert_array_equal(many, one_by_one)


@continuous
def test_densities_integrate_to_the_laws_the_model_states(name):
    model = models()[name]
    low, high = model.bounds()
    points = np.linspace(low, high, 21) if name == "histogram" else [0.0, 3.0]
    reach = (low, high) if name == "histogram" else (-400.0, 400.0)

    def expected(weight, pair):
        def inner(value):
            return weight(value) * model.density(value)[pair]

        return integrate.quad(inner, *reach, points=points, limit=400, epsabs=1e-10)[0]

    for pair in [(0, 0), (2, 1)]:
        assert expected(lambda value: 1.0, pair) == pytest.approx(1, abs=2e-6)
        assert expected(lambda value: value, pair) == pytest.approx(model.mean[pair], abs=1e-4)
        square = expected(lambda value: value**2, pair)
        assert square == pytest.approx(model.deviation[pair] ** 2 + model.mean[pair] ** 2, rel=2e-3)


@pytest.mark.slow
@continuous
@pytest.mark.parametrize("threshold", [-12.3, -1.0, 0.0, 2.4, 5.0, 11.0])
def test_excess_and_exceedance_agree_with_integration(name, threshold):
    model = models()[name]
    high = model.bounds()[1] if name == "histogram" else 3000.0
    start = max(threshold, model.bounds()[0]) if name == "histogram" else threshold
    if start >= high:
        assert (model.expected_excess(threshold) == 0).all()
        return
    breaks = np.linspace(start, high, 60)[1:-1]
    if isinstance(model, HistogramOutcomes):
        breaks = model.edges[(model.edges > start) & (model.edges < high)]
    elif high > 1000:
        breaks = start + np.geomspace(0.3, high - start, 40)[:-1]
    for pair in [(0, 0), (1, 0), (2, 1)]:
        excess, _ = integrate.quad(
            lambda value: (value - threshold) * model.density(value)[pair],  # noqa: B023
            start,
            high,
            points=breaks,
            limit=500,
        )
        above, _ = integrate.quad(
            lambda value: model.density(value)[pair],  # noqa: B023
            start,
            high,
            points=breaks,
            limit=500,
        )
        assert model.expected_excess(threshold)[pair] == pytest.approx(excess, rel=3e-6, abs=1e-7)
        assert model.exceedance(threshold)[pair] == pytest.approx(above, rel=1e-6, abs=1e-7)


@every_model
def test_table_rows_are_distributions_and_tell_the_types_apart(name):
    table = models()[name].table(4)
    assert table.probs.shape == (3, 2, 4)
    np.testing.assert_allclose(table.probs.sum(axis=2), 1, atol=1e-12)
    # Types 0 and 2 are eight apart under policy 0; pseudo-counts on six samples blur counted ones.
    assert np.abs(table.probs[0, 0] - table.probs[2, 0]).sum() > 0.7
    with pytest.raises(InputError, match="n_bins must be at least 2"):
        models()[name].table(1)


@every_model
def test_observing_is_fitting_with_one_more_but_for_what_is_pooled(name):
    data = samples()
    model = KINDS[name].from_samples(data[..., :-1])
    before = model.law()
    for type_, policy in np.ndindex(SHAPE):
        model.observe(type_, policy, data[type_, policy, -1])
    whole = KINDS[name].from_samples(data)
    np.testing.assert_allclose(model.mean, whole.mean, rtol=0.06, atol=1e-12)
    np.testing.assert_allclose(model.deviation, whole.deviation, rtol=0.15)
    # All that is derived is renewed: density, both layouts.
    fresh = KINDS[name].from_arrays(model.to_arrays())
    for value in (0.0, 3.0):
        np.testing.assert_allclose(model.density(value), fresh.density(value), rtol=1e-12)
        np.testing.assert_allclose(model.log_density(1, value), fresh.log_density(1, value), rtol=1e-12)
        np.testing.assert_allclose(model.expected_excess(value), fresh.expected_excess(value), rtol=1e-10)
        law, signal = model.law(), before.checked(value)
        np.testing.assert_allclose(
            law.log_likelihoods(1, signal), fresh.law(spread=model.spread).log_likelihoods(1, signal), rtol=1e-12
        )
        assert model.law() is law is not before or not law.learns
    np.testing.assert_allclose(model.deviation, fresh.deviation, rtol=1e-12)
    if law.learns:
        model.spread = Spread.known(0.5)
        assert model.law().spread.values.tolist() == [0.5]


@every_model
def test_arrays_give_the_same_bits_back(name):
    model = models()[name]
    model.observe(0, 0, 1.0)
    again = type(model).from_arrays(model.to_arrays())
    np.testing.assert_array_equal(again.mean, model.mean)
    for value in (0.0, 2.0):
        np.testing.assert_array_equal(again.density(value), model.density(value))
        np.testing.assert_array_equal(again.log_density(1, value), model.log_density(1, value))
    again.observe(0, 0, 2.0)
    assert again.mean[0, 0] != model.mean[0, 0]
    with pytest.raises(KeyError):
        type(model).from_arrays({})


@every_model
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, "3", None, [1.0, 2.0], 1e200])
def test_what_is_no_outcome_is_refused(name, value):
    model = models()[name]
    with pytest.raises(InputError, match="value must be a finite number"):
        model.log_density(0, value)
    before = model.mean.copy()
    with pytest.raises(InputError, match="value must be a finite number"):
        model.observe(0, 0, value)
    np.testing.assert_array_equal(model.mean, before)


@every_model
@pytest.mark.parametrize("policy", [2, -1, "a", None, 0.5])
def test_an_unknown_policy_or_type_is_refused(name, policy):
    model = models()[name]
    with pytest.raises(NotFoundError, match="unknown policy"):
        model.log_density(policy, 1.0)
    with pytest.raises(NotFoundError, match="unknown policy"):
        model.observe(0, policy, 1.0)
    with pytest.raises(NotFoundError, match="unknown type"):
        model.observe(3 if policy == 2 else policy, 0, 1.0)


@every_model
def test_samples_that_cannot_be_fitted_are_refused(name):
    fit = KINDS[name].from_samples
    with pytest.raises(InputError, match=r"samples must be \(n_types, n_policies, n\)"):
        fit([[1.0, 2.0]])
    with pytest.raises(InputError, match="none of them 0"):
        fit(np.empty((0, 2, 3)))
    with pytest.raises(InputError, match="must be finite"):
        fit([[[1.0, np.inf]]])
    with pytest.raises(InputError, match="1 have none, the first is type 1 with policy 0"):
        fit([[[1.0], [2.0]], [[np.nan], [3.0]]])
    with pytest.raises(InputError, match="numbers of one shape"):
        fit([[[1.0], [2.0]], [[3.0]]])


@pytest.mark.slow
@every_model
@settings(deadline=None, max_examples=60)
@given(
    st.integers(1, 3).flatmap(lambda n: st.lists(st.floats(-1e90, 1e90), min_size=2 * n, max_size=2 * n)),
    st.floats(-1e100, 1e100),
)
def test_whatever_finite_comes_no_number_is_lost(name, values, value):
    model = KINDS[name].from_samples(np.array(values).reshape(2, 1, -1))
    found = model.log_density(0, value)
    assert not np.isnan(found).any()
    assert (found < np.inf).all()
    excess = model.expected_excess(value)
    assert np.isfinite(excess).all()
    assert (excess >= 0).all()
    assert ((model.exceedance(value) >= 0) & (model.exceedance(value) <= 1)).all()
