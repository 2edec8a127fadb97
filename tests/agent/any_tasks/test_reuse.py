from collections import Counter
from copy import copy
from dataclasses import replace

import numpy as np
import pytest

from lifelore import LongLivedAgent
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.any_tasks.experience import Experience, TaskNews, TypeExperience
from lifelore.agent.any_tasks.known_types import KnownTypes
from lifelore.agent.any_tasks.one_task import SHORT
from lifelore.agent.any_tasks.reuse import TaskReuse
from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector


def sums(*values):
    return np.array([len(values), np.sum(values), np.square(values).sum()])


@pytest.fixture(scope="module")
def experience():
    """Two types that differ in ten moves; each has a policy, which earns nothing on the other."""
    made = Experience("key", 2)
    for name, other, outcome in (("a", "b", 1), ("b", "a", 2)):
        moves = Counter({(cause, outcome): 10 for cause in range(2, 22, 2)})
        returns = {name: sums(9.9, 10.1), other: sums(-0.1, 0.1)}
        made.types[name] = TypeExperience(moves, Counter(), returns, {})
    made.causes.update({(cause, 0): 2 for cause in range(2, 22, 2)})
    made.n_tasks = 2
    return made


def replace_types(experience, **types):
    """The same experience with other types of these names."""
    made = copy(experience)
    made.types = experience.types | types
    return made


@pytest.mark.parametrize(("prior", "falls_short"), [((1.0, 0.0), True), ((0.6, 0.4), False)])
def test_a_lost_bet_between_types_is_no_shortfall(experience, prior, falls_short):
    reuse = TaskReuse(experience, KnownTypes(experience), np.array(prior), LongLivedAgent(key="key").settings)
    assert reuse.begin_episode() == "a"
    reuse.end_episode("a", 0.0, True)
    assert (reuse.shortfall > SHORT) == falls_short
    assert reuse.shortfall == pytest.approx(
        (10 * prior[0]) / np.sqrt(reuse._deviation**2 + 100 * prior[0] * prior[1])
    )


def test_a_task_teaches_the_most_believed_type_alone(experience):
    reuse = TaskReuse(experience, KnownTypes(experience), np.array([0.4, 0.6]), LongLivedAgent(key="key").settings)
    assert reuse.best_member() == {"b": pytest.approx(0.6)}


def test_the_level_of_the_alarm_follows_how_often_it_was_false():
    """A ratio of rates by Gamma(1, 1) has the mean (1 + k) / (1 + 0.05 n) after n tasks with k false alarms."""
    one, other = Experience("key", 2), Experience("key", 2)
    assert one.alarm_level(0.05) == 0.05
    for date in range(20):
        alarm = None if date < 4 else date < 7
        news = TaskNews(date, 0, {}, Counter(), {}, ActionPrior(2, key="key/prior"), alarm=alarm)
        other.add(one.learn(news))
    for experience in (one, other):
        assert experience.alarm_level(0.05) == pytest.approx(0.05 * (1 + 0.05 * 16) / (1 + 3))
    quiet = Experience("key", 2)
    quiet.alarms[0] = 1000
    assert quiet.alarm_level(0.05) == 0.5


@pytest.mark.parametrize(("own", "runs"), [(10.0, "a"), (0.0, "b")])
def test_the_policy_of_the_most_believed_type_runs_unless_it_is_hopeless(experience, own, runs):
    """The other policy once earned 9.5 on this type, and 10 on its own: it has the larger expected return."""
    other = replace(experience.types["a"], returns={"a": sums(own, own), "b": sums(9.5)})
    known = replace_types(experience, a=other)
    reuse = TaskReuse(known, KnownTypes(known), np.array([0.6, 0.4]), LongLivedAgent(key="key").settings)
    assert reuse.policy == runs


def test_types_known_by_returns_alone_have_no_moves_to_judge():
    made = Experience("key", 2)
    for name in ("a", "b"):
        made.types[name] = TypeExperience(Counter(), Counter(), {name: sums(9.9, 10.1)}, {})
    made.n_tasks = 2
    reuse = TaskReuse(made, KnownTypes(made), np.array([0.5, 0.5]), LongLivedAgent(key="key").settings)
    assert not reuse.alarmed


def test_alarms_by_returns_cost_no_more_tasks_where_they_were_often_false(experience, monkeypatch):
    asked = []

    def calibrate(*args, n_tasks, false_alarm, **settings):
        asked.append((n_tasks, false_alarm))

    monkeypatch.setattr(NoveltyDetector, "calibrate", calibrate)
    often = copy(experience)
    often.alarms = np.array([200.0, 100.0])
    for false_alarm in (0.05, 0.01, 0.001):
        settings = LongLivedAgent(key="key", signals="returns", false_alarm=false_alarm).settings
        TaskReuse(often, KnownTypes(often), np.array([0.5, 0.5]), settings)
    assert asked == [(3673, pytest.approx(0.05 * 11 / 101)), (8000, 0.0025), (20000, 0.001)]
