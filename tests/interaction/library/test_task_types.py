"""ε-types and landmarks: the definition as printed, the tight bound 2 ε, and overlap."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lifelore.core.errors import InputError
from lifelore.interaction import PolicyLibrary, epsilon_types, landmark_library

TABLES = st.tuples(st.integers(1, 12), st.integers(1, 5)).flatmap(
    lambda shape: arrays(np.float64, shape, elements=st.integers(-20, 20).map(lambda k: k / 4))
)
"""Multiples of a quarter: sums and differences are exact, so that bounds can be tested without a tolerance."""
EPSILONS = st.integers(0, 40).map(lambda k: k / 8)


def distance(utilities, i, j):
    return max(abs(a - b) for a, b in zip(utilities[i], utilities[j], strict=True))


def landmark_regret(utilities, types):
    """Regret on each task of its landmark's best policy, of equally good ones the one with the largest regret."""
    regrets = []
    for task, type_ in zip(utilities, types.labels, strict=True):
        landmark = utilities[types.landmarks[type_]]
        regrets.append(max(task) - min(task[policy] for policy in np.flatnonzero(landmark == max(landmark))))
    return regrets


def test_no_more_than_epsilon_as_printed_can_be_broken_and_two_epsilon_is_reached():
    """On the landmark both policies are equally good; on the other task one is ε worse, the other ε better."""
    utilities = np.array([[10.0, 10.0], [9.0, 11.0]])
    types = epsilon_types(utilities, epsilon=1.0)
    assert types.n_types == 1
    assert landmark_regret(utilities, types) == [0.0, 2.0]


@pytest.mark.slow
@settings(deadline=None, max_examples=40)
@given(TABLES, EPSILONS)
def test_any_two_tasks_of_a_type_are_equivalent_as_the_definition_says(utilities, epsilon):
    types = epsilon_types(utilities, epsilon)
    for i, j in itertools.combinations(range(len(utilities)), 2):
        if types.labels[i] == types.labels[j]:
            assert distance(utilities, i, j) <= epsilon


@pytest.mark.slow
@settings(deadline=None, max_examples=40)
@given(TABLES, EPSILONS)
def test_every_task_has_one_type_whose_landmark_is_its_own_and_costs_at_most_two_epsilon(utilities, epsilon):
    types = epsilon_types(utilities, epsilon)
    assert types.labels[types.landmarks].tolist() == list(range(types.n_types))
    assert types.type_prior().sum() == pytest.approx(1)
    assert max(landmark_regret(utilities, types)) <= 2 * epsilon


def test_equivalence_is_not_transitive_so_a_task_may_fit_two_types():
    """0 and 1 are near, 1 and 2 are near, 0 and 2 are not: the middle task has one of the two types."""
    types = epsilon_types([[0.0], [1.0], [2.0]], epsilon=1.0)
    assert types.n_types == 2
    assert types.labels[1] in types.labels[[0, 2]]


def test_zero_joins_duplicates_only_and_plenty_joins_all():
    utilities = np.array([[1.0, 2.0], [1.0, 2.0], [1.0, 2.5]])
    assert epsilon_types(utilities, 0.0).n_types == 2
    assert epsilon_types(utilities, 0.5).n_types == 1
    assert landmark_regret(utilities, epsilon_types(utilities, 0.0)) == [0, 0, 0]


def test_the_landmark_is_the_member_in_the_middle():
    types = epsilon_types([[0.0], [1.0], [1.9]], epsilon=2.0)
    assert types.landmarks.tolist() == [1]


def test_library_of_landmarks():
    library = PolicyLibrary.from_means(
        [[0.0, 5.0], [0.5, 5.5], [9.0, 0.0]], 1.0, types=["a", "b", "c"], prior=[0.2, 0.3, 0.5]
    )
    reduced = landmark_library(library, epsilon_types(library.performance.mean, 1.0))
    assert reduced.n_types == 2
    by_name = dict(zip(reduced.types, reduced.prior, strict=True))
    assert by_name.pop("c") == 0.5
    assert next(iter(by_name.values())) == pytest.approx(0.5)
    with pytest.raises(InputError, match="types must cover"):
        landmark_library(library, epsilon_types([[1.0]], 0.0))


def test_a_prior_over_tasks_is_a_distribution():
    types = epsilon_types([[0.0], [1.0], [9.0]], 1.0)
    for prior in ([0.5, 0.5], [2.0, -1.0, 0.0], [np.nan, 0.5, 0.5]):
        with pytest.raises(InputError, match="prior must be"):
            types.type_prior(prior)


@pytest.mark.parametrize(
    ("utilities", "epsilon", "message"),
    [
        ([[np.nan]], 1.0, "finite"),
        ([1.0], 1.0, "finite"),
        ([[1.0]], -1.0, "epsilon must be"),
        ([[1.0]], np.nan, "epsilon must be"),
    ],
)
def test_bad_input_is_refused(utilities, epsilon, message):
    with pytest.raises(InputError, match=message):
        epsilon_types(utilities, epsilon)
