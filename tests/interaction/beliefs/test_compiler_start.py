"""The NumPy twins that a single choice runs without the compiler give the bits of the kernels."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lifelore.core.compiled import compiler_start
from lifelore.interaction.beliefs import belief
from lifelore.interaction.beliefs.bayes_rule import bayes_rule
from lifelore.interaction.beliefs.belief import update
from lifelore.interaction.beliefs.belief_kernels import bayes_row
from lifelore.interaction.selection import InformationDirected, information_kernels, mixtures, support_kernels
from lifelore.interaction.selection.choice import choose, tied_shares
from lifelore.interaction.selection.support import rising_least
from lifelore.interaction.selection.tie_kernels import choose_row, tied_rows
from lifelore.interaction.selection.ties import shares_of_tied

seeds = st.integers(0, 2**32 - 1)
logs = st.one_of(st.floats(-800, 300), st.just(-np.inf), st.sampled_from([0.0, -0.0, -1e308, 1e308]))


def same_bits(one, other) -> bool:
    return np.asarray(one, np.float64).tobytes() == np.asarray(other, np.float64).tobytes()


@settings(deadline=None, max_examples=300)
@given(st.data(), st.integers(1, 9))
def test_bayes_rule(data, n_types):
    prior = data.draw(arrays(float, n_types, elements=logs.map(lambda log: min(log, 0.0))))
    said = data.draw(arrays(float, n_types, elements=st.one_of(logs, st.sampled_from([np.nan, np.inf]))))
    compiled = prior.copy()
    evidence = bayes_row(compiled, said)
    after, plain = bayes_rule(prior, said)
    assert same_bits(after, compiled)
    assert same_bits(plain, evidence)


def test_the_belief_is_the_same_whichever_runs(monkeypatch):
    rng = np.random.default_rng(0)
    prior, said = np.log(rng.dirichlet(np.ones(7), (5, 3))), rng.normal(size=(5, 3, 7)) * 9
    compiled = update(prior, said)
    monkeypatch.setattr(belief, "kernel_pays", lambda numbers: False)
    plain = update(prior, said)
    assert same_bits(plain.log_belief, compiled.log_belief)
    assert same_bits(plain.log_evidence, compiled.log_evidence)


@settings(deadline=None, max_examples=200)
@given(seeds, st.integers(1, 60), st.sampled_from([1.0, 0.999, 0.9, 0.3]), st.booleans())
def test_least_kept(seed, n_types, mass, some_impossible):
    random = np.random.default_rng(seed)
    probs = random.dirichlet(np.full(n_types, 0.3))
    if some_impossible:
        probs[: n_types // 2] = 0.0
    assert same_bits(rising_least(probs, mass), support_kernels.least_kept(probs, mass))


@settings(deadline=None, max_examples=200)
@given(seeds, st.integers(1, 13), st.sampled_from([np.float64, np.float32]))
def test_mixtures(seed, n_kept, kind):
    random = np.random.default_rng(seed)
    probs = random.dirichlet(np.full(5, 0.5), (3, 13)).astype(kind)
    kept = np.sort(random.permutation(13)[:n_kept])
    share = random.dirichlet(np.ones(n_kept)).astype(kind)
    classes = random.integers(0, 4, (3, 13)).astype(np.int32)
    mixed = np.empty((3, 5), kind)
    information_kernels.mixtures(share, kept, probs, mixed)
    assert same_bits(mixtures.mixtures(share, kept, probs), mixed)
    information_kernels.class_mixtures(share, kept, classes, probs, mixed)
    assert same_bits(mixtures.class_mixtures(share, kept, classes, probs), mixed)


@settings(deadline=None, max_examples=200)
@given(arrays(float, st.integers(1, 9), elements=st.one_of(logs, st.just(np.inf), st.floats(0.999, 1.0))))
def test_shares_go_to_the_policies_that_the_kernel_may_choose(scores):
    uniforms = (np.arange(2520) + 0.5) / 2520  # A multiple of every number of tied policies.
    counts = np.bincount([choose_row(scores, u, 1e-9) for u in uniforms], minlength=len(scores))
    assert tied_shares(scores) == pytest.approx(counts / 2520)


@settings(deadline=None, max_examples=300)
@given(
    arrays(
        float,
        st.tuples(st.integers(1, 4), st.integers(1, 9)),
        elements=st.one_of(logs, st.sampled_from([np.inf, np.nan]), st.floats(1 - 3e-9, 1.0)),
    )
)
def test_shares_of_tied(scores):
    shares = np.empty_like(scores)
    tied_rows(scores, 1e-9, shares)
    plain = shares_of_tied(scores, 1e-9)
    assert np.array_equal(np.isnan(plain), np.isnan(shares))
    assert same_bits(np.nan_to_num(plain), np.nan_to_num(shares))


def test_near_ties_share_and_choose_alike():
    scores = np.array([1.0, 1.0 - 5e-10, 1.0 - 2e-9, -np.inf])
    assert tied_shares(scores).tolist() == [0.5, 0.5, 0.0, 0.0]
    assert {choose(scores, np.random.default_rng(seed)) for seed in range(20)} == {0, 1}


def test_large_work_starts_the_compiler(monkeypatch):
    monkeypatch.setattr(compiler_start, "sys", type("Sys", (), {"modules": {}}))
    assert not compiler_start.kernel_pays(compiler_start.NUMBERS_WORTH_A_START)
    assert compiler_start.kernel_pays(compiler_start.NUMBERS_WORTH_A_START + 1)


WITHOUT = """
import sys
import numpy as np
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection import rule_named
from lifelore.interaction.finite_signals.signal_table import SignalTable
library = PolicyLibrary.from_means(np.arange(24.0).reshape(8, 3) % 7, 2.0)
probs = np.random.default_rng(0).dirichlet(np.ones(8), (3, 8))
library.keep_table(8, SignalTable.restored(probs))
belief = np.array([0.5, 0.4997, 1e-4, 1e-4, 1e-4, 0, 0, 0])
for name in ("greedy", "epsilon-greedy", "sampling", "belief-entropy", "information-directed"):
    rule_named(name).probabilities(library, belief / belief.sum())
print([name for name in ("numba", "scipy.special", "scipy") if name in sys.modules])
"""


def test_five_rules_need_neither_compiler_nor_scipy():
    done = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_rule_scores_the_same_whichever_runs(monkeypatch):
    from lifelore.interaction.library.policy_library import PolicyLibrary
    from lifelore.interaction.selection import information, support

    rng = np.random.default_rng(1)
    library = PolicyLibrary.from_means(rng.normal(size=(30, 6)) * 5, 2.0)
    beliefs = rng.dirichlet(np.full(30, 0.05), 20)
    rule = InformationDirected()
    compiled = [rule.scores(library, one) for one in beliefs]
    for module in (information, support):
        monkeypatch.setattr(module, "kernel_pays", lambda numbers: False)
    assert same_bits([rule.scores(library, one) for one in beliefs], compiled)
