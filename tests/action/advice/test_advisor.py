"""The advisor by hand, against its slow twin, and by what must always hold."""

from math import log

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.action.advice.advisor import BETTER, TRACE, AdviceSettings, Advisor
from lifelore.action.advice.behaviour_models import Tabulated, Uniform
from lifelore.action.advice.goal_model import GoalModel, Trajectory
from lifelore.core.errors import InputError
from tests.action.advice.goal_models import goal_model_of


def all_open(theta, goals=()):
    """A purpose whose experts use alike all that `theta` (n_states, n_actions) does; α⁰ is drowned in counts."""
    purpose = goal_model_of(np.asarray(theta) > 0, goals)
    purpose.prior.update(np.arange(len(theta)), np.asarray(theta) > 0, 1e6)
    return purpose


def random_goal_models(random, n_goals, n_states, n_actions):
    return [
        GoalModel.from_trajectories(
            [
                Trajectory(random.integers(0, n_states, 7), random.integers(-1, n_actions, 6))
                for _ in range(random.integers(1, 4))
            ],
            n_states,
            n_actions,
            goals=[g],
        )
        for g in range(n_goals)
    ]


def random_advisor(random, n_goals, options) -> Advisor:
    n_states, n_actions = 9, 3
    headed = Tabulated(random.dirichlet(np.ones(n_actions), (n_states, n_actions + 1)))
    bound = [Tabulated(random.dirichlet(np.ones(n_actions), n_states)) for _ in range(n_goals)]
    models, likely = random_goal_models(random, n_goals, n_states, n_actions), random.uniform(0.2, 2.0, n_goals)
    return Advisor(models, [Uniform(3), headed, bound], options, goal_weights=likely)


# ---- by hand ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("used", [1, 2, 3, 4])
def test_gain_over_uniform_is_log_of_4_over_the_actions_in_use(used):
    theta = np.zeros((2, 4))
    theta[:, :used] = 1
    other = Advisor([all_open(theta)], weights=[1e-9, 1])  # nearly certain that it is lost
    advice = other.consider(other.watch(), 0)
    assert advice.gain == pytest.approx(log(4 / used), abs=1e-6)
    assert advice.advise == (used <= 2)  # log(4/3) = 0.29 < κ = 0.5 < log 2
    assert advice.theta == pytest.approx(theta[0] / used)


def test_posterior_and_gain_by_hand():
    # Experts always take 0 of two actions; one count and α⁰ = 0.1: P(0 | M₁) = 1.1/1.2, P(1 | M₁) = 0.1/1.2.
    purpose = goal_model_of([[True, False]] * 3)
    advisor = Advisor([purpose], settings=AdviceSettings(kappa=0.3))
    watch = advisor.watch()
    first = advisor.consider(watch, 0)
    assert first.p_normal == pytest.approx(0.5)
    # θ = (1, 0): the KL divergence is -log P(0 | s, H); what θ excludes adds nothing.
    assert first.gain == pytest.approx(-log(0.5 * 1.1 / 1.2 + 0.25))
    advisor.observe(watch, 0, 1)
    likelihood = 0.1 / 1.2, 0.5
    p_normal = likelihood[0] / sum(likelihood)
    second = advisor.consider(watch, 1)
    assert second.p_normal == pytest.approx(p_normal)
    assert second.gain == pytest.approx(-log(p_normal * 1.1 / 1.2 + (1 - p_normal) / 2))
    assert (first.advise, second.advise) == (True, True)
    assert not Advisor([purpose], settings=AdviceSettings(kappa=0.7)).consider(watch, 1).advise


def test_silent_where_no_expert_was_and_such_steps_prove_nothing():
    purpose = goal_model_of([[True, False], [False, False]])
    advisor = Advisor([purpose])
    watch = advisor.watch()
    for action in (0, 1, 1, 0, 1):
        advice = advisor.consider(watch, 1)
        assert advice == (False, pytest.approx([0, 0]), pytest.approx(0.5), 0.0, -1)
        advisor.observe(watch, 1, action)
    assert advisor.consider(watch, 0).p_normal == pytest.approx(0.5)


def test_one_step_never_proves_a_model_wrong_for_good():
    # A model that excludes what was done keeps TRACE; without it log 0 - log 0 would follow.
    sure = Tabulated([[1.0, 0.0]])
    advisor = Advisor([goal_model_of([[True, False]])], [sure], AdviceSettings(window=2))
    found = advisor.assess([0] * 6, [1, 0, 0, 0, 0, 0])
    assert found.posterior[1, 1] == pytest.approx(TRACE / (TRACE + 0.1 / 1.2))
    assert np.isfinite(found.gain).all()
    # Two steps on, the window has forgotten it: 1 against (1.1/1.2)².
    assert found.posterior[3, 1] == pytest.approx(1 / (1 + (1.1 / 1.2) ** 2))


def test_thousands_of_steps_do_not_underflow():
    purpose = goal_model_of([[True, False, False, False]])
    advisor = Advisor([purpose], settings=AdviceSettings(window=100_000))
    lost = np.tile([0, 1, 2, 3], 5000)
    assert advisor.assess(np.zeros(20_000, int), lost).p_normal[-1] < 1e-300
    assert advisor.assess(np.zeros(20_000, int), np.zeros(20_000, int)).p_normal[-1] == pytest.approx(1)


def test_a_goal_left_again_is_dropped_and_the_nearest_of_the_rest_comes_next():
    # States in a row; goals 0 and 4, experts went from 2 to either and from 1 and 3 too.
    def line(states, action):
        return Trajectory(np.array(states), np.full(len(states) - 1, action))

    west = GoalModel.from_trajectories([line([3, 2, 1, 0], 1)], 5, 2, [0])
    east = GoalModel.from_trajectories([line([0, 1, 2, 3, 4], 0)], 5, 2, [4])
    advisor = Advisor([west, east], settings=AdviceSettings(slip=0.05))
    watch = advisor.watch()
    assert [advisor.consider(watch, s).goal for s in (1, 3)] == [0, 1]
    advisor.observe(watch, 0, 0)
    assert [advisor.consider(watch, s).goal for s in (1, 2, 3)] == [1, 1, 1]
    assert advisor.consider(watch, 1).theta.tolist() == [1, 0]
    # Both seen and still under way: it begins again.
    advisor.observe(watch, 4, 1)
    assert advisor.consider(watch, 1).goal == 0


def test_steps_that_followed_advice_make_any_agent_seem_an_expert_unless_they_are_left_out():
    purpose = goal_model_of([[True, False]])
    for own_steps_only in (False, True):
        advisor = Advisor([purpose], settings=AdviceSettings(own_steps_only=own_steps_only))
        watch = advisor.watch()
        for _ in range(20):
            advisor.observe(watch, 0, 0, advised=True)
        expected = 0.5 if own_steps_only else 1 / (1 + (0.5 * 1.2 / 1.1) ** 20)
        assert advisor.consider(watch, 0).p_normal == pytest.approx(expected)


def test_goals_pooled_lead_nowhere_where_goals_apart_lead_straight():
    # A corridor with a goal at each end: the optimal policies are opposite in every place between.
    to_west = goal_model_of([[False, False], *[[False, True]] * 5, [False, True]], [0])
    to_east = goal_model_of([[True, False], *[[True, False]] * 5, [False, False]], [6])
    pooled = GoalModel.pooled([to_west, to_east])
    assert pooled.theta[1:6].tolist() == [[0.5, 0.5]] * 5
    always = Advisor.of_thesis([to_west, to_east], AdviceSettings(kappa=0))
    assert always.consider(always.watch(), 3).gain == pytest.approx(0)
    apart = Advisor([to_west, to_east], settings=AdviceSettings(slip=0.05))
    watch = apart.watch()
    assert sorted(apart.consider(watch, 3).theta.tolist()) == [0, 1]
    apart.observe(watch, 0, 0)
    assert all(apart.consider(watch, s).theta.tolist() == [1, 0] for s in range(1, 6))


# ---- against the twin ------------------------------------------------------------------------------


@settings(max_examples=40)
@given(st.integers(0, 10**6), st.sampled_from([0.1, 0.25, 0.4]), st.sampled_from([1.0, 7.0, 20.0]))
def test_advised_steps_never_exceed_their_share(seed, share, burst):
    random = np.random.default_rng(seed)
    advisor = random_advisor(random, 3, AdviceSettings(kappa=0.0, share=share, burst=burst))
    states, actions = random.integers(0, 9, 300), random.integers(0, 3, 300)
    advise = advisor.assess(states, actions).advise
    assert (np.cumsum(advise) <= share * np.arange(1, 301) + 1e-9).all()
    assert advise.any()


@settings(max_examples=30)
@given(st.integers(0, 10**6))
def test_at_once_is_step_by_step(seed):
    random = np.random.default_rng(seed)
    advisor = random_advisor(random, 2, AdviceSettings(kappa=0.2, window=5))
    states, actions = random.integers(0, 9, 30), random.integers(-1, 3, 30)
    found, watch = advisor.assess(states, actions), advisor.watch()
    assert found.posterior.sum(axis=1) == pytest.approx(np.ones(30))
    for t in range(30):
        advice = advisor.consider(watch, states[t])
        assert (advice.advise, advice.gain) == (found.advise[t], found.gain[t])
        assert advice.p_normal == pytest.approx(found.p_normal[t])
        advisor.observe(watch, states[t], actions[t])


# ---- mistakes -----------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"kappa": -1}, "kappa must be at least 0"),
        ({"window": 0}, "window must be at least 1"),
        ({"slip": 1}, "slip must be a share"),
        ({"share": 0}, "share must be a share"),
        ({"burst": 0.5}, "burst must be at least 1"),
        ({"kappa": float("nan")}, "kappa must be at least 0"),
    ],
)
def test_settings_that_break_a_rule(options, words):
    with pytest.raises(InputError, match=words):
        AdviceSettings(**options)


def test_advisors_that_cannot_be():
    one = goal_model_of([[True, False]])
    other = goal_model_of([[True, False], [True, True]])
    for arguments, words in (
        (([],), "goal_models must have at least one model"),
        (([one, other],), "goal_models must agree"),
        (([one, one], [[Uniform(2)]]), "one model for each of the 2 goals, got 1"),
        (([one], [Uniform(3)]), "non-negative probabilities of shape"),
        (([one], None, None, [1.0]), "weights must be 2 positive numbers"),
    ):
        with pytest.raises(InputError, match=words):
            Advisor(*arguments)  # type: ignore[arg-type]
    advisor = Advisor([one], settings=BETTER)
    with pytest.raises(InputError, match=r"state must lie in \[0, 1\), got 1"):
        advisor.consider(advisor.watch(), 1)
    with pytest.raises(InputError, match=r"action must lie in \[0, 2\) or be -1, got 2"):
        advisor.observe(advisor.watch(), 0, 2)
    with pytest.raises(InputError, match="as many"):
        advisor.assess([0], [0, 1])
