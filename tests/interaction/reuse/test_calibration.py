"""Calibration: by hand, right models on the line, wrong ones off it, and intervals that hold with groups."""

import numpy as np
import pytest
from scipy import stats

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.calibration import outcome_calibration, outcome_levels, type_calibration
from lifelore.interaction.selection import BeliefSampling

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


def test_levels_of_values_are_steps():
    model = CategoricalOutcomes([0.0, 1.0, 5.0], [[[0.2, 0.5, 0.3]], [[0.6, 0.4, 0.0]]])
    levels = outcome_levels(PolicyLibrary(model), [[0.5, 0.5]] * 3, [0, 0, 0], [0.0, 1.0, 5.0])
    assert levels == pytest.approx(np.array([[0, 0.4], [0.4, 0.85], [0.85, 1]]))


def test_even_cover_of_discrete_levels_is_calibrated_exactly():
    """Outcomes in just the predicted shares lie on the line at every level."""
    levels = np.repeat([[0, 0.4], [0.4, 0.85], [0.85, 1]], [40, 45, 15], axis=0)
    found = outcome_calibration(levels)
    assert found.observed == pytest.approx(found.predicted)
    assert found.error == pytest.approx(0, abs=1e-12)


def lived(library: PolicyLibrary, deviation: float, users: int = 300, episodes: int = 8):
    """Beliefs before each episode of users of known types, with policies, outcomes and users."""
    random, rows = np.random.default_rng(5), []
    for user in range(users):
        type_ = int(random.integers(3))
        agent = BayesianPolicyReuse(library, BeliefSampling(), seed=user)
        for _ in range(episodes):
            policy = agent.select()
            outcome = random.normal(MEANS[type_, policy], deviation)
            rows.append((agent.belief, policy, outcome, type_, user))
            agent.update(policy, outcome)
    return tuple(map(np.array, zip(*rows, strict=True)))


@pytest.mark.slow
def test_the_right_model_is_on_the_line_and_a_wrong_deviation_is_off_it():
    right = PolicyLibrary.from_means(MEANS, 4.0)
    beliefs, policies, outcomes, types, users = lived(right, 4.0)
    by_type = type_calibration(beliefs, types, users)
    by_outcome = outcome_calibration(outcome_levels(right, beliefs, policies, outcomes), users)
    # 2,400 outcomes: the deviation of a share is 0.01; beliefs of 300 users: about 0.03.
    assert by_outcome.error < 0.02
    assert by_type.error < 0.04
    assert by_outcome.groups == by_type.groups == 300
    sure = PolicyLibrary.from_means(MEANS, 2.0)
    beliefs, policies, outcomes, types, users = lived(sure, 4.0)
    narrow = outcome_calibration(outcome_levels(sure, beliefs, policies, outcomes), users)
    assert narrow.low[0] > 0.1
    assert narrow.high[-1] < 0.9
    assert narrow.error > 0.05
    certain = type_calibration(beliefs, types, users)
    assert certain.high[-1] < certain.predicted[-1]


@pytest.mark.slow
def test_intervals_contain_the_truth_with_groups_that_hang_together():
    """200 studies of 40 users with 1 to 10 outcomes whose levels share a part: 95 % of intervals."""
    random, held, narrow = np.random.default_rng(0), 0, 0
    for _ in range(200):
        users = np.repeat(np.arange(40), random.integers(1, 11, 40))
        level = stats.norm.cdf(0.8 * random.normal(size=40)[users] + 0.6 * random.normal(size=len(users)))
        found = outcome_calibration(np.stack([level, level], axis=1), users, at=(0.5,))
        held += found.low[0] <= 0.5 <= found.high[0]
        alone = outcome_calibration(np.stack([level, level], axis=1), at=(0.5,))
        narrow += alone.low[0] <= 0.5 <= alone.high[0]
    # The normal interval of 40 groups is a little too narrow: 93 % at worst, and 4 √(0.93 · 0.07 / 200) = 0.072.
    assert 0.93 - 0.072 <= held / 200 <= 1
    # Without groups, intervals would be too narrow.
    assert narrow / 200 < 0.8


@pytest.mark.parametrize("kind", ["gaussian", "student-t", "histogram", "categorical"])
def test_every_model_of_outcomes_gives_levels(kind):
    samples = np.random.default_rng(0).integers(0, 4, (3, 2, 9)).astype(float)
    library = PolicyLibrary.from_samples(samples, model=kind)
    levels = outcome_levels(library, np.full((4, 3), 1 / 3), [0, 1, 0, 1], [0.0, 1.0, 2.0, 3.0])
    assert ((levels[:, 0] <= levels[:, 1]) & (levels >= 0).all(axis=1) & (levels <= 1).all(axis=1)).all()
    assert (np.diff(levels[::2, 1]) > 0).all()


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
