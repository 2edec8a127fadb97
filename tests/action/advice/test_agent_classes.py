"""Advice by class: Bayes by hand, the advice of the likeliest class, and what a name tag does."""

import numpy as np
import pytest

from lifelore.action import AdviceSettings, Advisor, ClassAdvisor, GoalModel, Trajectory
from lifelore.action.advice.agent_classes import SURE, classes_with_goals
from lifelore.core.errors import InputError, NotFoundError

STAFF, VISITOR = 0, 1
PLAIN = AdviceSettings(kappa=0.0)


def pooled_classes(experts, settings, shares=None):
    """A prior for each class, over all its goals."""
    weights = None if shares is None else [shares[name] for name in experts]
    pooled = [GoalModel.pooled(models) for models in experts.values()]
    return ClassAdvisor(
        tuple(experts), Advisor(pooled, None, settings, goal_weights=weights), np.arange(len(experts))
    )


def walker(actions, n_states=3):
    """Experts of one goal who take the same actions in states 0, 1, … each time."""
    walk = Trajectory(np.arange(len(actions) + 1), np.array(actions))
    return GoalModel.from_trajectories([walk] * 4, n_states, 2)


@pytest.fixture
def models():
    """Staff go by action 0 and visitors by action 1 in state 1; in state 0 all take action 0."""
    return {"staff": [walker([0, 0])], "visitor": [walker([0, 1])]}


def test_the_class_is_inferred_by_bayes(models):
    known = pooled_classes(models, PLAIN)
    advisor = known.advisor
    agent = advisor.watch()
    advisor.consider(agent, 0)
    assert known.probs(agent) == {"staff": 0.5, "visitor": 0.5}
    advisor.observe(agent, 0, 0)
    advisor.consider(agent, 1)
    assert known.probs(agent) == {"staff": 0.5, "visitor": 0.5}, "all take this way"
    advisor.observe(agent, 1, 1)
    # Four experts and pseudo-counts of 0.1: P(1 | staff) = 0.1 / 4.2, P(1 | visitor) = 4.1 / 4.2.
    advice = advisor.consider(agent, 1)
    assert list(known.probs(agent).values()) == pytest.approx([0.1 / 4.2, 4.1 / 4.2])
    assert advice.goal == VISITOR
    assert advice.theta.tolist() == [0, 1]
    # With the uniform model: P(M | H) of both classes together.
    likelihood = np.array([0.1, 4.1]) / 4.2 * 4.1 / 4.2
    assert advice.p_normal == pytest.approx(likelihood.sum() / 4 / (likelihood.sum() / 4 + 0.5 * 0.25))


def test_goals_apart_are_as_likely_as_their_class():
    # A corridor of six places; staff go to its left end, visitors to its right end and to place 3.
    moves = np.array([[max(i - 1, 0), min(i + 1, 5)] for i in range(6)])
    moves[0, 0] = moves[5, 1] = -1

    def to(goal, start):
        step = 1 if goal > start else -1
        states = np.arange(start, goal + step, step)
        walk = Trajectory(states, np.full(len(states) - 1, int(step > 0)))
        return GoalModel.from_trajectories([walk], 6, 2, [goal])

    experts = {"staff": [to(0, 5)], "visitor": [to(5, 0), to(3, 0)]}
    known = classes_with_goals(experts, moves, PLAIN)
    assert known.class_of_goal.tolist() == [0, 1, 1]
    agent = known.advisor.watch()
    known.advisor.consider(agent, 2)
    # Half of the prior is that of the experts, and one class has two goals.
    assert agent.posterior == pytest.approx([0.25, 0.125, 0.125, 0.5])
    assert known.probs(agent) == pytest.approx({"staff": 0.5, "visitor": 0.5})
    shown = classes_with_goals(experts, moves, PLAIN, {"staff": 98.0, "visitor": 2.0})
    agent = shown.advisor.watch()
    assert shown.advisor.consider(agent, 2).goal == STAFF
    assert shown.probs(agent) == pytest.approx({"staff": 0.98, "visitor": 0.02})
    # Of one who walks at random, the tag tells the goal, although the visitors' place 3 is nearer.
    lost = shown.advisor.watch()
    for _ in range(40):
        for action in (0, 1):
            shown.advisor.observe(lost, 2, action)
    assert shown.advisor.consider(lost, 2).p_normal < 0.01
    assert shown.advisor.consider(lost, 2).goal == STAFF
    # Without a tag staff and visitors are as likely, and visitors have two goals.
    assert known.advisor.guide.goal_share == pytest.approx([1.5, 0.75, 0.75])
    for state in (1, 2, 3) * 5:
        shown.advisor.observe(agent, state, 1)
    assert shown.advisor.consider(agent, 4).goal == VISITOR, "who walks right is no staff, whatever the tag says"
    # The agent left place 3 without staying, so it is bound for the right end.
    assert agent.dropped.tolist() == [False, False, True]


def test_who_shows_a_class_is_advised_as_with_its_share(models):
    experts = {"staff": models["staff"], "visitor": models["visitor"], "cook": [walker([1, 1]), walker([1, 0])]}
    known = pooled_classes(experts, PLAIN)
    shown = known.showing("visitor")
    wanted = pooled_classes(experts, PLAIN, {"staff": 0.005, "visitor": SURE, "cook": 0.005}).advisor
    assert shown.guide.log_prior == pytest.approx(wanted.guide.log_prior)
    assert shown.guide.goal_share == pytest.approx(wanted.guide.goal_share)
    assert shown.guide.log_models is known.advisor.guide.log_models
    # The other classes keep their odds, and nothing changes for agents that show nothing.
    rare = pooled_classes(experts, PLAIN, {"staff": 3.0, "visitor": 5.0, "cook": 1.0})
    before = rare.advisor.guide.log_prior.copy()
    agent = rare.showing("visitor").watch()
    assert rare.probs(agent) == pytest.approx({"staff": 0.0075, "visitor": SURE, "cook": 0.0025})
    assert np.array_equal(rare.advisor.guide.log_prior, before)
    assert rare.advisor.rule == rare.showing("cook").rule
    alone = pooled_classes({"staff": models["staff"]}, PLAIN)
    assert alone.showing("staff") is alone.advisor
    with pytest.raises(NotFoundError, match="class must be one of staff, visitor, cook, got 'nurse'"):
        known.showing("nurse")


def test_classes_without_experts_and_strange_shares_are_refused(models):
    moves = np.zeros((3, 2), int)
    with pytest.raises(InputError, match=r"a goal model for each class, got none for \['guest'\]"):
        classes_with_goals(models | {"guest": []}, moves)
    with pytest.raises(InputError, match="got none for any class"):
        classes_with_goals({}, moves)
    for shares in ({"staff": 1.0}, {"staff": 1.0, "visitor": 0.0}):
        with pytest.raises(InputError, match="shares must be positive numbers of staff, visitor, got"):
            classes_with_goals(models, moves, None, shares)
