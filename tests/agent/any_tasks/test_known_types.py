from collections import Counter

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.any_tasks.experience import Experience, TaskNews, TypeExperience
from lifelore.agent.any_tasks.known_types import known_returns


def sums(*values):
    return np.array([len(values), np.sum(values), np.square(values).sum()])


def test_pairs_that_never_ran_are_guessed_with_doubt():
    experience = Experience("key", 2)
    experience.types["a"] = TypeExperience(returns={"a": sums(9.0, 11.0), "b": sums(2.0, 4.0)})
    experience.types["b"] = TypeExperience(returns={"b": sums(20.0, 20.0)})
    experience.types["c"] = TypeExperience(returns={"c": sums(1.0)})
    found = known_returns(experience, [("a",), ("b",), ("c",)], ("a", "b", "c"))
    usual = (3.0,)  # the only pair of a policy away from its own type
    assert found.mean == pytest.approx(np.array([[10, 3, usual[0]], [usual[0], 20, usual[0]], [1, 1, 1]]))
    deviation = np.sqrt((2 + 2 + 0) / (7 - 4))
    assert found.deviation == pytest.approx(np.full((3, 3), deviation))
    assert found.moments.count[0].tolist() == [2, 2, 1]


def test_members_of_a_joined_type_count_together():
    experience = Experience("key", 2)
    experience.types["a"] = TypeExperience(returns={"a": sums(1.0)})
    experience.types["b"] = TypeExperience(returns={"a": sums(3.0, 5.0)})
    assert known_returns(experience, [("a", "b")], ("a",)).mean.tolist() == [[3.0]]


def test_returns_of_a_policy_count_half_once_it_is_learnt_further():
    experience = Experience("key", 2)
    prior = ActionPrior(2, experience.prior.alpha0, experience.prior.key)
    for value in (0.0, 10.0):
        returns = {"a": [value] * 4, "b": [value] * 4}
        experience.learn(TaskNews(0, 0, {"a": 1.0}, Counter(), returns, prior, learner="a", policy={}))
    assert experience.types["a"].returns["a"] == pytest.approx(sums(*[0.0] * 2, *[10.0] * 4))
    assert experience.types["a"].returns["b"] == pytest.approx(sums(*[0.0] * 4, *[10.0] * 4))


def test_robots_that_learn_a_policy_further_at_the_same_time_leave_a_mean_that_was_earned():
    shared = Experience("key", 2)
    prior = ActionPrior(2, shared.prior.alpha0, shared.prior.key)

    def task(value, n):
        return TaskNews(0, 0, {"a": 1.0}, Counter(), {"a": [value] * n}, prior, learner="a", policy={})

    first = shared.learn(task(0.0, 8))
    apart = [Experience("key", 2) for _ in range(3)]
    for one in apart:
        one.add(first)
    later = [one.learn(task(1.0, 2)) for one in apart]
    for records in later:
        shared.add(records)
    assert shared.types["a"].returns["a"] == pytest.approx(sums(*[0.0] * 4, *[1.0] * 6))

    # The first robot's task is forgotten.
    rest = Experience("key", 2)
    rest.add([record for records in later for record in records])
    assert rest.types["a"].returns["a"] == pytest.approx(sums(*[1.0] * 6))
