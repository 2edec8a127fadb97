"""Advice by class: Bayes by hand, the advice of the likeliest class, and what a name tag does."""

import numpy as np
import pytest

from lifelore.action.advice.advisor import AdviceSettings, Advisor
from lifelore.action.advice.agent_classes import OWN_STEPS, class_advisor, class_probs
from lifelore.action.advice.goal_model import GoalModel, Trajectory
from lifelore.core.errors import InputError

STAFF, VISITOR = 0, 1
PLAIN = AdviceSettings(kappa=0.0)


def walker(actions, n_states=3):
    """Experts of one goal who take the same actions in states 0, 1, … each time."""
    walk = Trajectory(np.arange(len(actions) + 1), np.array(actions))
    return GoalModel.from_trajectories([walk] * 4, n_states, 2)


@pytest.fixture
def models():
    """Staff go by action 0 and visitors by action 1 in state 1; in state 0 all take action 0."""
    return {"staff": [walker([0, 0])], "visitor": [walker([0, 1])]}


def test_the_class_is_inferred_by_bayes(models):
    advisor = class_advisor(models, PLAIN)
    agent = advisor.watch()
    advisor.consider(agent, 0)
    assert class_probs(advisor, agent).tolist() == [0.5, 0.5]
    advisor.observe(agent, 0, 0)
    advisor.consider(agent, 1)
    assert class_probs(advisor, agent).tolist() == [0.5, 0.5], "all take this way"
    advisor.observe(agent, 1, 1)
    # Four experts and pseudo-counts of 0.1: P(1 | staff) = 0.1 / 4.2, P(1 | visitor) = 4.1 / 4.2.
    advice = advisor.consider(agent, 1)
    assert class_probs(advisor, agent) == pytest.approx([0.1 / 4.2, 4.1 / 4.2])
    assert advice.goal == VISITOR
    assert advice.theta.tolist() == [0, 1]
    # With the uniform model: P(M | H) of both classes together.
    likelihood = np.array([0.1, 4.1]) / 4.2 * 4.1 / 4.2
    assert advice.p_normal == pytest.approx(likelihood.sum() / 4 / (likelihood.sum() / 4 + 0.5 * 0.25))


def test_a_name_tag_is_a_prior_and_no_proof(models):
    advisor = class_advisor(models, PLAIN, {"visitor": 1.0, "staff": 9.0})
    agent = advisor.watch()
    assert advisor.consider(agent, 1).goal == STAFF
    assert class_probs(advisor, agent) == pytest.approx([0.9, 0.1])
    advisor.observe(agent, 1, 1)
    assert advisor.consider(agent, 1).goal == VISITOR
    assert class_probs(advisor, agent) == pytest.approx(np.array([0.9 * 0.1, 0.1 * 4.1]) / (0.09 + 0.41))


def test_advised_steps_do_not_confirm_a_class(models):
    advisor = class_advisor(models)
    assert advisor.settings == OWN_STEPS
    agent = advisor.watch()
    for _ in range(50):
        advisor.observe(agent, 1, 1, advised=True)
    advisor.consider(agent, 1)
    assert class_probs(advisor, agent).tolist() == [0.5, 0.5]


def test_one_class_is_the_thesis(models):
    every = [*models["staff"], *models["visitor"]]
    ours, thesis = class_advisor({"anyone": every}, PLAIN), Advisor.of_thesis(every, PLAIN)
    steps = np.random.default_rng(0).integers(0, 2, (2, 60))
    for found, wanted in zip(ours.assess(*steps), thesis.assess(*steps), strict=True):
        assert np.array_equal(found, wanted)


def test_classes_without_experts_and_strange_shares_are_refused(models):
    with pytest.raises(InputError, match="at least one goal model for each class, got none for \\['guest'\\]"):
        class_advisor(models | {"guest": []})
    with pytest.raises(InputError, match="at least one goal model"):
        class_advisor({})
    with pytest.raises(InputError, match="shares must name the classes staff, visitor, got staff"):
        class_advisor(models, None, {"staff": 1.0})
    with pytest.raises(InputError, match="goal_weights must be 2 positive numbers"):
        class_advisor(models, None, {"staff": 1.0, "visitor": 0.0})
