"""Outcomes of a few values, by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes


def calls():
    """The telephone's returns: 10 for success, 3 otherwise."""
    return CategoricalOutcomes([10.0, 3.0], [[[1.0, 0.0], [0.6, 0.4]]])


def test_numbers_by_hand():
    model = calls()
    np.testing.assert_allclose(model.mean, [[10.0, 7.2]])
    np.testing.assert_allclose(model.deviation, [[0.0, 7 * np.sqrt(0.24)]])
    np.testing.assert_allclose(model.exceedance(3.0), [[1.0, 0.6]])
    np.testing.assert_allclose(model.expected_excess(8.0), [[2.0, 1.2]])
    assert model.log_density(0, 3.0).tolist() == [-np.inf]
    np.testing.assert_allclose(model.log_density(1, 3.0), np.log([0.4]))
    assert model.bounds() == (3.0, 10.0)


def test_values_are_found_to_rounding_and_others_are_impossible():
    model = CategoricalOutcomes([0.3, 1e6], [[[0.5, 0.5]]])
    assert model.log_density(0, 0.1 + 0.2)[0] == pytest.approx(np.log(0.5))
    assert model.log_density(0, 1e6 + 1e-4)[0] == pytest.approx(np.log(0.5))
    assert model.log_density(0, 0.31).tolist() == [-np.inf]
    assert model.log_density(0, -5.0).tolist() == [-np.inf]


def test_fitted_values_are_those_seen_and_listed_ones_may_be_more():
    model = CategoricalOutcomes.from_samples([[[3.0, 3.0, 10.0]], [[10.0, 0.1 + 0.2, 0.3]]])
    assert len(model.values) == 3
    np.testing.assert_allclose(model.probs[1, 0], np.array([2.5, 0.5, 1.5]) / 4.5)
    listed = CategoricalOutcomes.from_samples([[[3.0]]], values=[10, 3, 5], pseudo_count=1.0)
    np.testing.assert_allclose(listed.probs, [[[0.5, 0.25, 0.25]]])
    with pytest.raises(InputError, match="outside the model's values 3, 10"):
        CategoricalOutcomes.from_samples([[[5.0]]], values=[10, 3])
