"""Feature functions: state, task, last reward and agent class as columns of one context."""

import numpy as np
import pytest

from lifelore.action.features.feature_function import (
    AgentClass,
    JoinedFeatures,
    LastReward,
    StateFeatures,
    TaskFeature,
    context_codes,
)
from lifelore.action.features.feature_set import FeatureSet
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError, NotFoundError

PERCEPT = StateFeatures(FeatureSet(("wall", "door"), (2, 2)), np.array([[0, 1], [1, 0], [1, 1]]))
COLOUR = TaskFeature("colour", 3, lambda task: task["colour"])
REWARD = LastReward((0.0, 50.0))
CLASSES = ("walker", "wheels")


def joined(own: str = "wheels") -> JoinedFeatures:
    return JoinedFeatures((PERCEPT, COLOUR, REWARD, AgentClass(CLASSES, own)))


def test_all_four_side_by_side_by_hand():
    phi = joined()
    assert phi.features.names == ("wall", "door", "colour", "last reward", "agent class")
    assert phi.features.sizes == (2, 2, 3, 3, 2)
    rows = phi([2, 0], {"colour": 2}, [-10.0, 100.0])
    assert rows.tolist() == [[1, 1, 2, 0, 1], [0, 1, 2, 2, 1]]
    # 1·36 + 1·18 + 2·6 + 0·2 + 1 = 67 and 0 + 18 + 12 + 2·2 + 1 = 35
    assert context_codes(phi, [2, 0], {"colour": 2}, [-10.0, 100.0]).tolist() == [67, 35]


def test_one_reward_for_all_states():
    told = context_codes(joined(), [0, 1, 2], {"colour": 0})
    assert np.array_equal(told, context_codes(joined(), [0, 1, 2], {"colour": 0}, [0.0] * 3))
    with pytest.raises(InputError, match="last_rewards must be one number or 3, a number for each state, got 2"):
        context_codes(joined(), [0, 1, 2], {"colour": 0}, [0.0, 1.0])


def test_agents_of_another_class_have_counts_of_their_own():
    # §3.7: the class is part of the context, and can be left out again to pool all agents.
    walker, wheels = (context_codes(joined(own), [1], {"colour": 0}) for own in CLASSES)
    prior = ActionPrior(2)
    prior.update(walker, [[True, False]])
    prior.update(wheels, [[False, True]])
    assert prior.counts(walker).tolist() == [[1, 0]]
    assert prior.counts(wheels).tolist() == [[0, 1]]
    features = joined().features
    anyone = [name for name in features.names if name != "agent class"]
    pooled = prior.marginalise(features.coarser(prior.contexts, anyone))
    assert pooled.counts(features.coarser(walker, anyone)).tolist() == [[1, 1]]


def test_reward_classes_begin_at_their_edges():
    assert REWARD([0] * 4, None, [-1e-9, 0.0, 49.9, 50.0]).ravel().tolist() == [0, 1, 1, 2]


def test_broken_rules():
    with pytest.raises(InputError, match="edges must be finite and ascending"):
        LastReward((1.0, 1.0))
    with pytest.raises(NotFoundError, match="agent class must be one of walker, wheels, got 'bird'"):
        AgentClass(CLASSES, "bird")
    with pytest.raises(InputError, match=r"feature 'colour' must lie in \[0, 3\)"):
        context_codes(joined(), [0], {"colour": 3})
    with pytest.raises(InputError, match="must be distinct"):
        _ = JoinedFeatures((COLOUR, COLOUR)).features
