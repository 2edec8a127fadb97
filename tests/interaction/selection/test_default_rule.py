"""The default rule: the one that claim O1 chose, the same everywhere, and never the policy of wide outcomes."""

import json
from pathlib import Path

import numpy as np

from lifelore.agent.personalise.fitting.fit import FitSettings
from lifelore.agent.personalise.study import Study
from lifelore.app import reuse_command
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.selection import DEFAULT_RULE, Greedy, default_rule, rule_named
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.joint_signal import JointSignal
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal
from lifelore.interaction.signals.return_signal import ReturnSignal
from reproduction.engine.registry import RESULTS
from reproduction.own.o_01_default_rule.run import CANDIDATES, decided_rule
from reproduction.own.o_01_default_rule.run import RULES as COMPARED


def test_the_default_is_the_rule_that_the_claim_decided_for():
    result = json.loads((RESULTS / "O1" / "result.json").read_text(encoding="utf-8"))
    assert result["mode"] == "full"
    assert COMPARED[decided_rule(result["measured"], CANDIDATES)] == rule_named(DEFAULT_RULE)
    # Over all six rules the decision names another rule; docs/policy_reuse.md says why it is not the default.
    assert decided_rule(result["measured"]) == "KG"


def test_agents_users_studies_and_the_command_share_the_default():
    means = np.random.default_rng(0).normal(scale=5, size=(4, 5))
    library = PolicyLibrary.from_means(means, np.linspace(1, 30, 20).reshape(4, 5))
    agent, users = BayesianPolicyReuse(library), UserBeliefs(library, 30, "f8")
    assert agent.rule == default_rule(library) == rule_named(DEFAULT_RULE)
    every = np.arange(30)
    users.update(every, every % 5, np.linspace(-9, 9, 30))
    assert np.array_equal(users.select(every), users.select(every, DEFAULT_RULE))
    assert np.array_equal(users.probabilities(every), users.probabilities(every, DEFAULT_RULE))
    study = Study("s", library, dict.fromkeys(library.policies, "active"))
    assert FitSettings().rule == study.rule == DEFAULT_RULE
    assert study.selection == agent.rule
    text = Path(reuse_command.__file__).read_text(encoding="utf-8")
    assert f"default: {DEFAULT_RULE}." in text


def test_signals_without_a_table_get_a_rule_that_needs_none():
    own = LikelihoodSignal(lambda policy, seen: [0.0, -abs(seen)], 2)
    known = CategorySignal(np.array([[[0.3, 0.7]] * 2, [[0.9, 0.1]] * 2]))
    for signal, has_table in (
        (own, False),
        (JointSignal([known, own]), False),
        (JointSignal([known, known]), True),
    ):
        library = PolicyLibrary.from_means([[1.0, 0.0], [0.0, 1.0]], 1.0, signal=signal)
        assert library.has_table == has_table
        assert (default_rule(library) == Greedy()) != has_table
        assert BayesianPolicyReuse(library).select() in (0, 1)
    plain = PolicyLibrary.from_means([[1.0, 0.0]], 1.0)
    assert isinstance(plain.signal, ReturnSignal)
    assert plain.has_table
