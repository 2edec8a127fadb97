"""Acquisition of features: by hand on worlds whose hidden feature, noise or disagreement is known."""

import numpy as np
import pytest

from lifelore.action.features.feature_acquisition import AcquisitionSettings, FeatureAcquisition
from lifelore.action.features.feature_set import FeatureSet
from lifelore.core.errors import InputError, NotFoundError

WORLD = FeatureSet(("seen", "noise", "hidden"), (2, 3, 2))
QUICK = AcquisitionSettings(patience=1, trial=1)


def task(rng, rule):
    """Codes of 600 states and their best action (of two); `rule` gives it from the columns (600, 3)."""
    columns = rng.integers(0, WORLD.sizes, (600, 3))
    return WORLD.codes(columns), np.eye(2, dtype=bool)[rule(columns)]


def by_hidden(columns):
    return columns[:, 2]


def test_a_hidden_feature_is_acquired_and_noise_is_dropped():
    rng = np.random.default_rng(0)
    agent = FeatureAcquisition(WORLD, ["seen"], ["a", "b"], settings=QUICK)
    agent.update(*task(rng, by_hidden))
    assert agent.entropy == pytest.approx(1.0, abs=0.02)
    assert agent.on_trial == "noise"
    agent.update(*task(rng, by_hidden))
    assert [(trial.feature, trial.kept) for trial in agent.trials] == [("noise", False)]
    # Where nothing is to be seen, 600 states save some bits by chance: about (3 − 1) · 2 · 1 / (2 · 600 · ln 2).
    assert agent.trials[0].saved < 0.02
    agent.update(*task(rng, by_hidden))
    assert agent.on_trial == "hidden"
    agent.update(*task(rng, by_hidden))
    assert agent.chosen.names == ("seen", "hidden")
    assert agent.trials[1].saved == pytest.approx(1.0, abs=0.02)
    assert agent.entropy == 0.0
    # Nothing is tried any more, and the prior knows what to do.
    for _ in range(3):
        agent.update(*task(rng, by_hidden))
    assert agent.on_trial is None
    codes = WORLD.codes([[0, 2, 1], [1, 0, 0]])
    assert agent.probs(codes).argmax(axis=1).tolist() == [1, 0]


def test_tasks_that_disagree_teach_that_no_feature_helps():
    rng = np.random.default_rng(1)
    agent = FeatureAcquisition(WORLD, ["seen"], ["a", "b"], settings=QUICK)
    for number in range(10):
        # Each task wants one action everywhere, but another task the other: no feature tells which.
        agent.update(*task(rng, lambda columns, wanted=number % 2: np.full(len(columns), wanted)))
    assert agent.chosen.names == ("seen",)
    assert [trial.kept for trial in agent.trials] == [False, False]
    assert agent.entropy == pytest.approx(1.0, abs=0.01)


def test_wrong_names_and_settings_are_refused():
    with pytest.raises(InputError, match="candidates must be none of the features at the start, got 'seen'"):
        FeatureAcquisition(WORLD, ["seen"], ["a"], ["seen"])
    with pytest.raises(NotFoundError, match="features must be among seen, noise, hidden, got 'colour'"):
        FeatureAcquisition(WORLD, ["seen"], ["a"], ["colour"])
    for settings, words in (
        ({"high": -1.0}, "high must be at least 0 bits"),
        ({"patience": 0}, "patience must be at least 1 task"),
        ({"trial": 0}, "trial must be at least 1 task"),
        ({"least": 0.0}, "least must be above 0 bits"),
    ):
        with pytest.raises(InputError, match=words):
            AcquisitionSettings(**settings)
