"""Choices among the available policies: as a library without the others, by hand, and clear errors."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection import RULES, BeliefSampling, EpsilonGreedy, Greedy, rule_named
from lifelore.interaction.selection.availability import (
    MOST_PARTS,
    available_policies,
    available_probabilities,
    available_scores,
    best_policies,
)
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal

NAMES = ["a", "b", "c", "d"]


def learnt_library(seed: int = 0, n_types: int = 5, model: str = "gaussian") -> PolicyLibrary:
    random = np.random.default_rng(seed)
    samples = random.normal(random.normal(scale=5, size=(n_types, 4, 1)), 2, (n_types, 4, 8))
    samples = np.round(samples / 4) if model == "categorical" else samples
    return PolicyLibrary.from_samples(samples, policies=NAMES, model=model)


@pytest.mark.parametrize(
    "available",
    [["d", "b"], ("b", "d", "b"), [3, 1], np.array([1, 3]), {"b", "d"}, ["b", 3], [False, True, False, True],
     np.array([0, 1, 0, 1], bool)],
)  # fmt: skip
def test_names_numbers_and_masks_mean_the_same(available):
    assert available_policies(available, NAMES).tolist() == [1, 3]


@pytest.mark.parametrize("available", ["b", 1])
def test_a_single_policy_needs_no_list(available):
    assert available_policies(available, NAMES).tolist() == [1]


@pytest.mark.parametrize(
    ("available", "error", "words"),
    [
        ([], InputError, "at least one policy, got none"),
        (np.zeros(4, bool), InputError, "at least one policy, got none"),
        ([True, False], InputError, r"\(4,\) bool"),
        (["b", "e"], NotFoundError, "unknown policy 'e'"),
        ([4], NotFoundError, "unknown policy 4"),
        ([-1], NotFoundError, "unknown policy -1"),
    ],
)
def test_bad_sets_are_refused_by_all_three(available, error, words):
    agent = BayesianPolicyReuse(learnt_library())
    for call in (agent.select, agent.probabilities, lambda chosen: agent.select_top(1, chosen)):
        with pytest.raises(error, match=words):
            call(available)


@pytest.mark.parametrize("name", sorted(RULES))
@pytest.mark.parametrize("model", ["gaussian", "student-t", "categorical", "histogram"])
def test_a_rule_scores_as_in_a_library_without_the_others(name, model):
    library, rule = learnt_library(model=model), rule_named(name)
    for policies in ([0, 2], [1], [1, 2, 3]):
        part, numbers = library.take(policies=policies), np.array(policies)
        for row in np.random.default_rng(1).dirichlet(np.ones(5), 3):
            draws = [np.random.default_rng(3) for _ in range(2)]
            scores = available_scores(rule, library, row, numbers, episodes_left=9, generator=draws[0])
            alone = rule.scores(part, row, episodes_left=9, generator=draws[1])
            np.testing.assert_array_equal(scores[policies], alone)
            assert np.isnan(np.delete(scores, policies)).all()
            probs = available_probabilities(rule, library, row, numbers, episodes_left=9)
            assert np.array_equal(probs[policies], rule.probabilities(part, row, episodes_left=9))
            assert not np.delete(probs, policies).any()


@pytest.mark.parametrize("name", sorted(RULES))
def test_all_policies_available_is_as_no_mask_bit_for_bit(name):
    library = learnt_library(2)
    masked, free = (BayesianPolicyReuse(library, rule_named(name), seed=5) for _ in range(2))
    for outcome in np.random.default_rng(0).normal(0, 5, 12):
        assert np.array_equal(masked.probabilities(NAMES), free.probabilities())
        policy = masked.select(NAMES)
        assert policy == free.select()
        masked.update(policy, outcome)
        free.update(policy, outcome)
    assert masked.generator.random() == free.generator.random()


def test_sampling_takes_the_best_available_response_by_hand():
    library = PolicyLibrary.from_means([[9.0, 5.0, 1.0], [1.0, 2.0, 8.0], [7.0, 3.0, 3.0]], 1.0)
    agent = BayesianPolicyReuse(library, BeliefSampling(), prior=[0.5, 0.3, 0.2])
    # Without the first policy, the first type's best response is the second; the third type's two are equal.
    assert agent.probabilities([1, 2]) == pytest.approx([0.0, 0.5 + 0.1, 0.3 + 0.1])
    drawn = np.bincount([agent.select([1, 2]) for _ in range(2000)], minlength=3) / 2000
    # Four deviations of a share of 2,000 draws: 4 √(0.24 / 2000) = 0.044.
    assert drawn == pytest.approx([0.0, 0.6, 0.4], abs=0.044)


def test_exploration_is_over_available_policies_by_hand():
    library = PolicyLibrary.from_means([[9.0, 5.0, 1.0, 3.0]], 1.0)
    agent = BayesianPolicyReuse(library, EpsilonGreedy(0.3))
    assert agent.probabilities([1, 2, 3]) == pytest.approx([0, 0.8, 0.1, 0.1])


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from(sorted(RULES)), st.lists(st.booleans(), min_size=4, max_size=4).filter(any), st.integers(0, 99)
)
def test_probabilities_are_a_distribution_over_available_policies(name, mask, seed):
    belief = np.random.default_rng(seed).dirichlet(np.full(5, 0.3))
    agent = BayesianPolicyReuse(learnt_library(1), rule_named(name), belief, seed=seed)
    probs = agent.probabilities(mask)
    assert probs.sum() == pytest.approx(1)
    assert (probs[~np.array(mask)] == 0).all()
    assert probs[agent.select(mask)] > 0


@pytest.mark.parametrize("name", sorted(RULES))
def test_the_best_k_are_ranked_by_score_and_begin_with_the_selected(name):
    library = learnt_library(4)
    ranking, selecting = (BayesianPolicyReuse(library, rule_named(name), seed=8) for _ in range(2))
    ranked = ranking.select_top(4)
    assert ranked[0].policy == selecting.select()
    assert sorted(one.policy for one in ranked) == [0, 1, 2, 3]
    assert [NAMES[one.policy] for one in ranked] == [one.name for one in ranked]
    scores = [one.score for one in ranked]
    assert all(first >= second - 1e-9 * abs(first) for first, second in pairwise(scores))
    assert len(ranking.select_top(2, ["a", "d"])) == 2
    explained = ranking.explain()
    assert {explained.selected, explained.runner_up} == {"a", "d"}


def test_equal_policies_are_ranked_at_random():
    library = PolicyLibrary.from_means([[1.0, 1.0, 0.0, 1.0]], 1.0)
    agent = BayesianPolicyReuse(library, Greedy())
    orders = {tuple(one.policy for one in agent.select_top(4)) for _ in range(100)}
    # A given order of three is missing from 100 draws with probability (5/6)^100 = 1e-8.
    assert len(orders) == 6
    assert {order[3] for order in orders} == {2}


@pytest.mark.parametrize(("k", "available"), [(0, None), (5, None), (3, ["a", "b"])])
def test_a_k_that_there_is_not_is_refused(k, available):
    with pytest.raises(InputError, match="k must be 1 to"):
        BayesianPolicyReuse(learnt_library()).select_top(k, available)


def test_a_rank_of_minus_infinity_names_no_policy_twice():
    ranked = best_policies(np.array([-np.inf, 2.0, -np.inf, np.nan]), 3, np.random.default_rng(0))
    assert ranked[0] == 1
    assert sorted(ranked) == [0, 1, 2]


def test_the_only_available_policy_has_no_runner_up():
    agent = BayesianPolicyReuse(learnt_library())
    assert agent.select(["c"]) == 2
    explained = agent.explain()
    assert (explained.selected, explained.runner_up, explained.runner_up_score) == ("c", None, None)


def test_a_signal_that_cannot_be_restricted_is_no_hindrance():
    signal = LikelihoodSignal(lambda policy, seen: np.array([0.0, -1.0]), n_types=2)
    library = PolicyLibrary.from_means([[3.0, 2.0, 1.0], [1.0, 2.0, 3.0]], 1.0, signal=signal)
    agent = BayesianPolicyReuse(library, Greedy())
    agent.update(0, "seen")
    assert agent.select([1, 2]) == 1
    with pytest.raises(InputError, match="no finite alphabet"):
        BayesianPolicyReuse(library, rule_named("belief-entropy")).select([1, 2])


def test_what_the_library_learns_reaches_masked_scores():
    library = PolicyLibrary.from_means([[5.0, 4.0, 3.0]], 1.0, count=1)
    rule, belief, policies = rule_named("belief-entropy"), np.ones(1), np.array([1, 2])
    assert np.nanargmax(available_scores(rule, library, belief, policies)) == 1
    for _ in range(9):
        library.observe(0, 2, 10.0)
    assert np.nanargmax(available_scores(rule, library, belief, policies)) == 2


def test_a_table_that_changes_in_place_is_read_anew():
    library = learnt_library()
    belief, rule, policies = np.full(5, 0.2), rule_named("information-directed"), np.array([0, 2])
    before = available_scores(rule, library, belief, policies)
    table = library.table(8)
    table.probs[2] = 1 / table.n_signals
    table.conditional_entropy[2] = np.log(table.n_signals)
    after = available_scores(rule, library, belief, policies)
    assert after[0] == before[0]
    # The second policy's signals now tell nothing: the least information, 1e-9 nats, divides the regret.
    lost = belief @ library.performance.mean[:, policies].max(axis=1) - belief @ library.performance.mean[:, 2]
    assert after[2] == pytest.approx(-lost / 1e-9**0.5)


def test_more_sets_than_are_stored_choose_the_same():
    random = np.random.default_rng(0)
    wide = PolicyLibrary.from_samples(random.normal(size=(3, 8, 6)))
    rule, belief = rule_named("information-directed"), np.full(3, 1 / 3)
    sets = [np.flatnonzero(random.random(8) < 0.6) for _ in range(3 * MOST_PARTS)]
    sets = [policies for policies in sets if policies.size]
    first = [available_scores(rule, wide, belief, policies) for policies in sets]
    for policies, scores in zip(sets, first, strict=True):
        np.testing.assert_array_equal(available_scores(rule, wide, belief, policies), scores)
