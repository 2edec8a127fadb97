"""What a prior tells of itself, by hand."""

import json
import math

import pytest

from lifelore.action import ActionPrior, prior_report


def small() -> ActionPrior:
    prior = ActionPrior(2)
    prior.update([0, 1], [[True, True], [True, False]])
    prior.update([0, 1], [[True, True], [True, False]])
    return prior


def test_of_all_it_knows_by_hand():
    told = prior_report(small())
    assert json.loads(json.dumps(told)) == told
    assert told == {
        "contexts": 2,
        "counted": 6.0,
        "unseen_rate": 0.0,
        "entropy": pytest.approx(math.log(2) / 2),
        "entropy_by_counts": pytest.approx(math.log(2) * 4 / 6),
        "sure_rate": 0.5,
        "useful_actions": 0.75,
        "exclusion_rate": None,
    }


def test_of_the_contexts_met_by_hand():
    # Context 9 is unseen: open, nothing masked. Context 1 excludes its best action once of three.
    best = [[True, False], [False, True], [False, True], [False, False]]
    told = prior_report(small(), [0, 1, 9, 1], best)
    assert told["unseen_rate"] == 0.25
    assert told["entropy"] == pytest.approx(math.log(2) / 2)
    assert told["sure_rate"] == 0.5
    assert told["useful_actions"] == 0.75
    assert told["exclusion_rate"] == pytest.approx(1 / 3)
