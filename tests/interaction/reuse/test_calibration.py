"""Calibration: by hand, right models on the line, wrong ones off it, and intervals that hold with groups."""

import numpy as np
import pytest
from scipy import stats

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.calibration import outcome_calibration, outcome_levels, type_calibration

MEANS = np.array([[6.0, 0.0, 3.0], [0.0, 6.0, 3.0], [2.0, 2.0, 5.0]])


def test_types_by_hand():
    found = type_calibration([[0.9, 0.1], [0.7, 0.3], [0.7, 0.3]], [0, 1, 0])
    assert found.predicted == pytest.approx([0.1, 0.3, 0.7, 0.9])
    assert found.observed.tolist() == [0, 0.5, 0.5, 1]
    assert found.n.tolist() == [1, 2, 2, 1]
    assert found.error == pytest.approx((0.1 + 2 * 0.2 + 2 * 0.2 + 0.1) / 6)
    assert found.groups == 3
    assert np.isnan(found.low).all()
    assert found.to_dict()["ci95"] == [None] * 4


def test_levels_of_normals_are_mixtures_by_hand():
    library = PolicyLibrary.from_means(MEANS, [[1.0, 2.0, 3.0]] * 3)
    belief = np.array([[0.5, 0.3, 0.2], [0.0, 1.0, 0.0]])
    levels = outcome_levels(library, belief, [1, 2], [1.5, 4.0])
    first = belief[0] @ stats.norm.cdf((1.5 - MEANS[:, 1]) / 2)
    assert levels[:, 1] == pytest.approx([first, stats.norm.cdf(1 / 3)])
    assert levels[:, 0] == pytest.approx(levels[:, 1], abs=1e-12)


def test_even_cover_of_discrete_levels_is_calibrated_exactly():
    """Outcomes in just the predicted shares lie on the line at every level."""
    levels = np.repeat([[0, 0.4], [0.4, 0.85], [0.85, 1]], [40, 45, 15], axis=0)
    found = outcome_calibration(levels)
    assert found.observed == pytest.approx(found.predicted)
    assert found.error == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(
    ("beliefs", "types", "words"),
    [
        ([[0.5, 0.6]], [0], "sum to 1 in each row"),
        ([[0.5, 0.5]], [2], "types must be 0 to 1"),
        ([[0.5, 0.5]], [0, 1], r"types \(n,\) int"),
        ([[0.5, 0.5]], [0.0], r"types \(n,\) int"),
        (np.empty((0, 2)), np.empty(0, int), r"beliefs must be \(n, n_types\)"),
    ],
)
def test_bad_beliefs_are_refused(beliefs, types, words):
    with pytest.raises(InputError, match=words):
        type_calibration(beliefs, types)


@pytest.mark.parametrize(
    ("policies", "outcomes", "words"),
    [([0, 1], [1.0], "policies"), ([3], [1.0], "policies must be numbers from 0 to 2"), ([0], [np.nan], "finite")],
)
def test_bad_outcomes_are_refused(policies, outcomes, words):
    with pytest.raises(InputError, match=words):
        outcome_levels(PolicyLibrary.from_means(MEANS, 1.0), [[1, 0, 0]], policies, outcomes)


def test_bad_levels_groups_and_bins_are_refused():
    for levels, at, words in [
        ([[0.5, 0.4]], (0.5,), "in this order"),
        (np.empty((0, 2)), (0.5,), "at least one outcome"),
        ([[0.1, 0.4]], (0.0,), "within"),
        ([[0.1, 0.4]], (), "at least one"),
    ]:
        with pytest.raises(InputError, match=words):
            outcome_calibration(levels, at=at)
    with pytest.raises(InputError, match="groups must be"):
        outcome_calibration([[0.1, 0.4]], [1, 2])
