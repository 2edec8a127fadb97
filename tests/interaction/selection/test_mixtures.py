"""Supports and mixtures in NumPy have the bits of their kernels; a choice by stored tables needs no compiler."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection import InformationDirected, information, information_kernels, mixtures, support
from lifelore.interaction.selection.support import rising_least

seeds = st.integers(0, 2**32 - 1)


def same_bits(one, other) -> bool:
    return np.asarray(one, np.float64).tobytes() == np.asarray(other, np.float64).tobytes()


@pytest.mark.slow
@settings(deadline=None, max_examples=200)
@given(seeds, st.integers(1, 60), st.sampled_from([1.0, 0.999, 0.9, 0.3]), st.booleans())
def test_least_kept(seed, n_types, mass, some_impossible):
    random = np.random.default_rng(seed)
    probs = random.dirichlet(np.full(n_types, 0.3), 3)
    if some_impossible:
        probs[:, : n_types // 2] = 0.0
    least = np.empty(3)
    information_kernels.least_kept(probs, mass, least)
    assert same_bits([rising_least(row, mass) for row in probs], least)


@pytest.mark.slow
@settings(deadline=None, max_examples=200)
@given(seeds, st.integers(1, 13), st.sampled_from([np.float64, np.float32]))
def test_mixtures(seed, n_kept, kind):
    random = np.random.default_rng(seed)
    probs = random.dirichlet(np.full(5, 0.5), (3, 13)).astype(kind)
    kept = np.sort(random.permutation(13)[:n_kept])
    share = random.dirichlet(np.ones(n_kept)).astype(kind)
    classes = random.integers(0, 4, (3, 13)).astype(np.int32)
    policies = random.permutation(3)[: random.integers(1, 4)]
    mixed = np.empty((len(policies), 5), kind)
    information_kernels.mixtures(share, kept, policies, probs, mixed)
    assert same_bits(mixtures.mixtures(share, kept, policies, probs), mixed)
    information_kernels.class_mixtures(share, kept, classes, policies, probs, mixed)
    assert same_bits(mixtures.class_mixtures(share, kept, classes, policies, probs), mixed)


WITHOUT = """
import sys
import numpy as np
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection import rule_named
from lifelore.interaction.finite_signals.signal_table import SignalTable
library = PolicyLibrary.from_means(np.arange(24.0).reshape(8, 3) % 7, 2.0)
probs = np.random.default_rng(0).dirichlet(np.ones(8), (3, 8))
library.keep_table(8, SignalTable.restored(probs))
belief = np.array([0.5, 0.4997, 1e-4, 1e-4, 1e-4, 0, 0, 0])
for name in ("greedy", "epsilon-greedy", "sampling", "belief-entropy", "information-directed"):
    rule_named(name).probabilities(library, belief / belief.sum())
agent = BayesianPolicyReuse(library, rule_named("information-directed"))
for outcome in (3.0, 5.0, -1.0):
    agent.update(1, outcome)
agent.skip(), agent.probabilities(), agent.belief
print([name for name in ("numba", "scipy.special", "scipy") if name in sys.modules])
"""


@pytest.mark.slow
def test_five_rules_and_an_agents_updates_need_neither_compiler_nor_scipy():
    done = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_rule_scores_the_same_whichever_runs(monkeypatch):
    rng = np.random.default_rng(1)
    library = PolicyLibrary.from_means(rng.normal(size=(30, 6)) * 5, 2.0)
    beliefs = rng.dirichlet(np.full(30, 0.05), 20)
    rule = InformationDirected()
    compiled = [rule.scores(library, one) for one in beliefs]
    for module in (information, support):
        monkeypatch.setattr(module, "kernel_pays", lambda numbers: False)
    assert same_bits([rule.scores(library, one) for one in beliefs], compiled)
