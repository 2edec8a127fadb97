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
from lifelore.interaction.selection import BeliefSampling, ExpectedImprovement, Greedy

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
@pytest.mark.parametrize("name", ["gaussian", "category", "transition", "own", "exact outcomes"])
@both_precisions
@pytest.mark.parametrize("hazard", [0.05, 1e-36, 1.0])
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


def test_users_take_four_bytes_a_type_and_twice_twelve_a_policy_of_learnt_models():
    mean, n = np.zeros((68, 50)), 1000
    static = TypeDynamics.static()
    beliefs = UserBeliefs(PolicyLibrary.from_means(mean, 1.0), n, dynamics=static)
    assert beliefs.log_belief.nbytes / n == 4 * 68
    # Beside it, whether an episode has begun, and the probability of the only spread: 9 bytes.
    assert beliefs.algorithm.nbytes / n <= 4 * 68 + 9
    learnt = UserBeliefs(PolicyLibrary.from_means(mean, 1.0, count=5), n, dynamics=static)
    # Of the unknown type what was shown, the probability of its only spread, and the odds.
    assert learnt.algorithm.nbytes / n <= 4 * 68 + 12 * 50 + 9 + 12 * 50 + 16
    # By default the belief over five hazards given the type.
    moving = UserBeliefs(PolicyLibrary.from_means(mean, 1.0), n)
    assert moving.algorithm.nbytes / n <= 4 * 68 * (1 + 5) + 9


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


@pytest.mark.slow
@pytest.mark.parametrize("name", ["gaussian", "histogram"])
@pytest.mark.parametrize("hazard", [0.0, 0.002])
@both_precisions
def test_forty_thousand_hostile_signals_leave_beliefs(name, hazard, dtype):
    random, n, model = np.random.default_rng(0), 1000, library(name)
    users, every = UserBeliefs(model, n, dtype, dynamics=TypeDynamics.hazard(hazard, model.prior)), np.arange(n)
    for turn in range(40):
        size = 10.0 ** random.uniform(-320, 100, n)
        signals = np.where(turn % 3 == 0, random.normal(size=n), random.choice([-1.0, 1.0], n) * size)
        signals[:2] = 1e100, -1e100
        who, policies = random.permutation(n), random.integers(0, N_POLICIES, n)
        chosen = users.update_and_select(who, policies, signals, "sampling")
        assert ((chosen >= 0) & (chosen < N_POLICIES)).all()
        assert (users.log_belief <= 0).all()
        assert np.abs(np.exp(users.log_belief.astype(float)).sum(axis=1) - 1).max() < 1e-5
    assert np.isfinite(users.algorithm.outcomes.shown).all()
    for rule in ("greedy", "expected-improvement"):
        assert users.select(every, rule).shape == (n,)

    # (5 · 10 + 40 · 6) / 45 = 6.44 < 8.


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
