"""Many users at once: as one agent a user, whatever the blocks, hostile signals, and what a user costs."""

import math
from typing import Any

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.reuse import user_beliefs
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.selection import RULES, BeliefSampling, ExpectedImprovement, Greedy, rule_named
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal

from .families import FAMILIES, N_POLICIES, N_TYPES, with_spread

STATIC = TypeDynamics.static()
TOLERANCE = {"f8": 1e-12, "f4": 1e-5}
FLOOR = 1e-6
"""Above this, float32 beliefs of exact models also hold to 1e-4 of themselves."""
both_precisions = pytest.mark.parametrize("dtype", ["f4", "f8"])


def library(name: str = "exact outcomes") -> PolicyLibrary:
    """A library whose users of a type differ by a known spread, where it is learnt from runs."""
    return with_spread(FAMILIES[name].library(), Spread.known(0.3))


def drawn(name: str, random: np.random.Generator, n: int) -> list[Any]:
    return [FAMILIES[name].draw(random) for _ in range(n)]


@pytest.mark.slow
@pytest.mark.parametrize("name", FAMILIES)
@both_precisions
@pytest.mark.parametrize("hazard", [0.0, 0.05, 1e-36, 1.0])
def test_a_batch_agrees_with_one_agent_a_user(name, dtype, hazard, monkeypatch):
    """Users come twice in a batch, blocks are small, and a hazard of 1e-36 is too small for float32."""
    monkeypatch.setattr(user_beliefs, "BLOCK", 7 * N_TYPES)
    model, random, close = library(name), np.random.default_rng(0), TOLERANCE[dtype]
    dynamics = TypeDynamics.hazard(hazard, model.prior)
    users = UserBeliefs(model, 12, dtype, dynamics=dynamics)
    agents = [BayesianPolicyReuse(model, dynamics=dynamics) for _ in range(12)]
    for _ in range(8):
        who, policies = random.integers(0, 12, 30), random.integers(0, N_POLICIES, 30)
        signals = drawn(name, random, 30)
        evidence = users.update(who, policies, signals)
        for k, (user, policy, signal) in enumerate(zip(who.tolist(), policies.tolist(), signals, strict=True)):
            agents[user].update(policy, signal)
            expected = agents[user].explain().log_evidence[-1]
            assert evidence[k] == expected or evidence[k] == pytest.approx(expected, rel=close, abs=20 * close)
        one_by_one, found = np.array([agent.belief for agent in agents]), users.belief(np.arange(12))
        assert found == pytest.approx(one_by_one, abs=close if hazard < 1 else 10 * close)
        if not FAMILIES[name].learns:
            above = one_by_one > FLOOR
            assert found[above] == pytest.approx(one_by_one[above], rel=10 * close)
    every = np.arange(12)
    # A hazard of 1 leaves the prior, under which policies of counted outcomes tie; float32 breaks these ties.
    for rule in (Greedy(), BeliefSampling(), ExpectedImprovement()) if dtype == "f8" or hazard < 1 else ():
        stated = users.probabilities(every, rule)
        for user, agent in enumerate(agents):
            agent.rule = rule
            assert stated[user] == pytest.approx(agent.probabilities(), abs=100 * close), rule.name


def test_the_spread_is_the_mean_of_the_librarys_or_the_callers():
    model = library("gaussian")
    model.performance.spread = Spread.up_to(0.6)  # pyright: ignore[reportAttributeAccessIssue]
    for given, spread in ((None, 0.6 * (1 / 16 + 1 / 4 + 1) / 6), (0.2, 0.2), (0.0, 0.0)):
        users, known = UserBeliefs(model, 1, "f8", spread=given), library("gaussian")
        known.performance.spread = Spread.known(spread)  # pyright: ignore[reportAttributeAccessIssue]
        agent = BayesianPolicyReuse(known)
        for outcome in (10.0, 30.0):
            users.update([0], [1], [outcome])
            agent.update(1, outcome)
        assert users.belief([0])[0] == pytest.approx(agent.belief, abs=1e-12)
    for bad in (-0.1, np.inf, np.nan):
        with pytest.raises(InputError, match="spread must be at least 0"):
            UserBeliefs(model, 1, spread=bad)


@both_precisions
@pytest.mark.parametrize("name", ["greedy", "expected-improvement", "knowledge-gradient", "belief-entropy"])
def test_rules_select_what_one_agent_a_user_selects(dtype, name):
    model, random = library(), np.random.default_rng(1)
    users = UserBeliefs(model, 700, dtype)
    policies, signals = random.integers(0, N_POLICIES, 700), drawn("exact outcomes", random, 700)
    together = users.update_and_select(np.arange(700), policies, signals, name, episodes_left=5)
    assert np.array_equal(together, users.select(np.arange(700), name, episodes_left=5))
    rule, differ = rule_named(name), 0
    for user in range(700):
        scores = rule.scores(model, users.belief([user])[0], episodes_left=5)
        # float32 may decide otherwise between policies that score the same to its precision.
        assert scores[together[user]] >= scores.max() - 1e-4 * np.abs(scores).max()
        differ += scores.argmax() != together[user]
    assert differ <= (0 if dtype == "f8" else 3)


@pytest.mark.parametrize("name", ["exact outcomes", "gaussian", "categorical"])
def test_sampling_follows_the_stated_probabilities(name):
    random = np.random.default_rng(2)
    users, every = UserBeliefs(library(name), 20_000), np.arange(20_000)
    for policy in (1, 0, 1):
        users.update(every, np.full(20_000, policy), drawn(name, random, 1) * 20_000)
    for available in (None, np.array([False, True])):
        stated = users.probabilities([0], "sampling", available=available)[0]
        chosen = users.select(every, "sampling", available=available)
        # A share of 20000 has a deviation of at most 0.0035; five of them.
        assert np.bincount(chosen, minlength=N_POLICIES) / 20_000 == pytest.approx(stated, abs=0.018)


def test_users_take_four_bytes_a_type_and_twelve_a_policy_of_learnt_models():
    mean, n = np.zeros((68, 50)), 1000
    static = TypeDynamics.static()
    beliefs = UserBeliefs(PolicyLibrary.from_means(mean, 1.0), n, dynamics=static)
    assert beliefs.log_belief.nbytes / n == 4 * 68
    # Beside it, whether an episode has begun, and the probability of the only spread: 9 bytes.
    assert beliefs.algorithm.nbytes / n <= 4 * 68 + 9
    learnt = UserBeliefs(PolicyLibrary.from_means(mean, 1.0, count=5), n, dynamics=static)
    assert learnt.algorithm.nbytes / n <= 4 * 68 + 12 * 50 + 9
    # By default the belief over five hazards given the type, and whether it has just changed.
    moving = UserBeliefs(PolicyLibrary.from_means(mean, 1.0), n)
    assert moving.algorithm.nbytes / n <= 4 * 68 * (1 + 5 + 1) + 9


def test_a_user_may_come_twice_across_and_within_blocks(monkeypatch):
    monkeypatch.setattr(user_beliefs, "BLOCK", 50 * N_TYPES)
    model, n, random = library("gaussian"), 210, np.random.default_rng(3)
    who, policies, signals = random.integers(0, 2, n), random.integers(0, N_POLICIES, n), random.normal(size=n)
    for dynamics in (None, TypeDynamics.transitions(0.9 * np.eye(N_TYPES) + 0.1 / N_TYPES)):
        users = UserBeliefs(model, 3, "f8", dynamics=dynamics)
        users.update(who, policies, signals)
        for user in (0, 1):
            agent = BayesianPolicyReuse(model, dynamics=dynamics)
            for policy, signal in zip(policies[who == user].tolist(), signals[who == user].tolist(), strict=True):
                agent.update(policy, signal)
            assert users.log_belief[user] == pytest.approx(agent.log_belief, rel=1e-9, abs=1e-9)
        assert np.array_equal(users.log_belief[2], np.log(model.prior))


def test_what_float32_reads_as_zero_it_does_not_forget():
    model = PolicyLibrary.from_means([[0.0, 0.0], [20.0, 0.0]], 1.0)
    users = UserBeliefs(model, 1, dynamics=STATIC)
    for _ in range(3):
        users.update([0], [0], [0.0])
    # Each signal has a log likelihood ratio of 200: far below the least float32. Three signals the other way
    # bring the belief back.
    assert users.log_belief[0, 1] == pytest.approx(-600, rel=1e-5)
    assert users.belief([0])[0] == pytest.approx([1.0, 0.0], abs=1e-37)
    assert users.select([0], "sampling").tolist() in ([0], [1])
    for _ in range(3):
        users.update([0], [0], [20.0])
    assert users.belief([0]) == pytest.approx(np.array([[0.5, 0.5]]), abs=1e-3)


@both_precisions
def test_a_hazard_steps_where_no_type_explains_the_signal_and_spares_impossible_types(dtype):
    probs = np.array([[[1.0, 0.0, 0.0]], [[0.5, 0.5, 0.0]], [[0.5, 0.5, 0.0]]])
    model = PolicyLibrary.from_means(np.eye(3, 1), 1.0, signal=CategorySignal(probs), prior=[0.5, 0.5, 0.0])
    dynamics = TypeDynamics.hazard(0.1, model.prior)
    users = UserBeliefs(model, 2, dtype, dynamics=dynamics)
    assert users.update([0, 1], [0, 0], [0, 2]).tolist() == [pytest.approx(np.log(0.75)), -np.inf]
    assert users.belief([0])[0] == pytest.approx([0.9 * 2 / 3 + 0.05, 0.9 / 3 + 0.05, 0.0], rel=1e-6)
    assert users.belief([1])[0] == pytest.approx([0.5, 0.5, 0.0], rel=1e-6)
    # A signal of the second type alone, then none: 0.9 * 1 + 0.05, and from there 0.9 * 0.95 + 0.05.
    users.update([0], [0], [1])
    assert users.belief([0])[0] == pytest.approx([0.05, 0.95, 0.0], rel=1e-6)
    users.update([0], [0], [2])
    assert users.belief([0])[0] == pytest.approx([0.095, 0.905, 0.0], rel=1e-6)
    # A belief in a type that the prior excludes stays in the logarithm however small it is.
    users = UserBeliefs(
        PolicyLibrary.from_means([[0.0], [40.0]], 1.0), 1, dtype, dynamics=TypeDynamics.hazard(0.1, [1.0, 0.0])
    )
    users.update([0], [0], [0.0])
    assert users.log_belief[0, 1] == pytest.approx(-800 + np.log(0.9), rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["exact outcomes", "gaussian", "uneven", "histogram"])
@pytest.mark.parametrize("hazard", [0.0, 0.002])
@both_precisions
def test_a_hundred_thousand_hostile_signals_leave_beliefs(name, hazard, dtype):
    random, n, model = np.random.default_rng(0), 1000, library(name)
    users, every = UserBeliefs(model, n, dtype, dynamics=TypeDynamics.hazard(hazard, model.prior)), np.arange(n)
    for turn in range(100):
        size = 10.0 ** random.uniform(-320, 100, n)
        signals = np.where(turn % 3 == 0, random.normal(size=n), random.choice([-1.0, 1.0], n) * size)
        signals[:2] = 1e100, -1e100
        who, policies = random.permutation(n), random.integers(0, N_POLICIES, n)
        chosen = users.update_and_select(who, policies, signals, "sampling")
        assert ((chosen >= 0) & (chosen < N_POLICIES)).all()
        assert (users.log_belief <= 0).all()
        assert np.abs(np.exp(users.log_belief.astype(float)).sum(axis=1) - 1).max() < 1e-5
    for array in users.algorithm.outcomes.shown.arrays.values():
        assert np.isfinite(array).all()
    for rule in ("greedy", "expected-improvement"):
        assert users.select(every, rule).shape == (n,)


def test_users_that_are_reset_are_new_and_the_others_stay():
    random, n = np.random.default_rng(0), 40
    users, fresh, every = (
        UserBeliefs(library("gaussian"), n, "f8"),
        UserBeliefs(library("gaussian"), 1, "f8"),
        np.arange(n),
    )
    for policy in range(N_POLICIES):
        users.update(every, np.full(n, policy), random.normal(size=n))
    before, size = users.belief(every[1::2]), users.algorithm.nbytes
    users.reset([*every[::2], 0])
    assert users.belief([0])[0] == pytest.approx(users.library.prior)
    assert np.array_equal(users.belief(every[1::2]), before)
    users.update([14], [1], [7.0])
    fresh.update([0], [1], [7.0])
    assert users.belief([14]) == pytest.approx(fresh.belief([0]), abs=1e-12)
    assert users.algorithm.nbytes == size

    # (5 · 10 + 40 · 6) / 45 = 6.44 < 8.


@both_precisions
def test_probabilities_are_those_by_which_is_selected_where_policies_are_nearly_equal(dtype):
    """Off-policy estimates divide by the logged probability, so it must hold however small the difference is."""
    near = [[1.0, 1.0 + 1e-8], [1.0, 1.0]]
    users = UserBeliefs(PolicyLibrary.from_means(near, 1.0), 4000, dtype, prior=[1.0, 0.0])
    for rule in ("greedy", "sampling"):
        stated = users.probabilities([0], rule)[0]
        assert stated.tolist() == [0.0, 1.0]
        # Four deviations of a share of 4000.
        assert np.bincount(users.select(np.arange(4000), rule), minlength=2) / 4000 == pytest.approx(
            stated, abs=0.032
        )


def test_evidence_below_the_range_of_numbers_is_not_that_of_the_impossible():
    values = {0: [-8e307, 0.0], 1: [-8e307, -np.inf]}
    signal = LikelihoodSignal(lambda policy, x: values[int(x)], 2)
    model = PolicyLibrary.from_means([[0.0], [1.0]], 1.0, signal=signal)
    users = UserBeliefs(model, 1, "f8", dynamics=STATIC)
    agent = BayesianPolicyReuse(model, dynamics=STATIC, models="plug-in")
    for x in (0, 1):
        evidence = users.update([0], [0], [x])
        agent.update(0, x)
    assert np.isfinite(evidence).all()
    assert agent.unexplained == 0
    assert users.log_belief[0].tolist() == agent.log_belief.tolist() == [0.0, -np.inf]


# ---- bad input -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (([0, 3], [0, 0], [1.0, 1.0]), NotFoundError, "unknown user 3; there are 3"),
        (([-1], [0], [1.0]), NotFoundError, "unknown user -1"),
        (([0], [2], [1.0]), NotFoundError, "unknown policy 2; there are 2"),
        (([0.5], [0], [1.0]), InputError, "whole numbers"),
        (([[0]], [0], [1.0]), InputError, "whole numbers"),
        (([0], [0], [math.nan]), InputError, "value must be a finite number"),
        (([0], [0], [math.inf]), InputError, "value must be a finite number"),
        (([0], [0], [1e200]), InputError, "value must be a finite number"),
        (([0, 1], [0], [1.0]), InputError, "equally many, got 2, 1 and 1"),
    ],
)
def test_arguments_that_break_their_rule_are_refused(arguments, error, message):
    users = UserBeliefs(library(), 3)
    before = users.log_belief.copy()
    with pytest.raises(error, match=message):
        users.update(*arguments)
    assert np.array_equal(users.log_belief, before)


def test_there_must_be_a_user_or_names():
    with pytest.raises(InputError, match="users must be at least 1"):
        UserBeliefs(library(), 0)
    assert UserBeliefs(library(), []).n_users == 0


def test_nothing_to_do_is_nothing_done():
    users = UserBeliefs(library(), 3)
    assert users.update([], [], []).shape == (0,)
    assert users.select([]).shape == (0,)
    assert set(RULES) == {name for name in RULES if users.select([1], name).shape == (1,)}
