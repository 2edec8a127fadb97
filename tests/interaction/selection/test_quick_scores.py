"""Scores in float32 and by screens: the choice of exact scores, bounds that hold, and odd tables and beliefs."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection import (
    BeliefEntropy,
    InformationDirected,
    KnowledgeGradient,
    information_bounds,
    knowledge_gradient,
    signal_rows,
    tied_shares,
)
from lifelore.interaction.selection.exact_best import exact_best
from lifelore.interaction.selection.information import expected_noise, mutual_information
from lifelore.interaction.selection.information_bounds import rounded_bound, tangent_bound
from lifelore.interaction.selection.knowledge_bounds import joined_gain, rounded_gain
from lifelore.interaction.selection.knowledge_gradient import knowledge_gain, knowledge_scores
from lifelore.interaction.selection.support import supported_types
from lifelore.interaction.signals.category_signal import CategorySignal

from ..twins import naive_rules as naive

MASS = 0.999
seeds = st.integers(0, 2**32 - 1)
MODULES = (signal_rows, information_bounds, knowledge_gradient)


@pytest.fixture
def single(monkeypatch):
    """Tables of any size are copied to float32."""
    monkeypatch.setattr(signal_rows, "LEAST_NUMBERS", 1)


@pytest.fixture
def large(monkeypatch):
    """Tables of any size count as large."""
    for module in MODULES:
        monkeypatch.setattr(module, "MOST_NUMBERS", 0)
    monkeypatch.setattr(knowledge_gradient, "EXACT_WORK", 0)


def learnt(random, n_types, n_policies, n_signals, kind: type = np.float64):
    """Means, and a table in which no two types are alike and some signals nearly impossible."""
    probs = random.dirichlet(np.full(n_signals, 0.2), (n_policies, n_types)) + 1e-12
    probs[random.random(probs.shape) < 0.1] = 2e-9
    probs /= probs.sum(axis=2, keepdims=True)
    return random.normal(scale=30, size=(n_types, n_policies)), SignalTable(probs.astype(kind))


def any_size(random):
    n_types, n_policies, n_signals = random.integers((1, 1, 2), (12, 12, 9))
    return learnt(random, n_types, n_policies, n_signals)


def beliefs(random, n_types):
    """A belief as flat, as narrow, or with as many impossible types as chance has it."""
    belief = random.dirichlet(np.full(n_types, 10 ** random.uniform(-2, 1)))
    if random.random() < 0.3:
        belief[random.random(n_types) < 0.5] = 0
    return belief / belief.sum() if belief.sum() > 0 else np.eye(n_types)[0]


def library_of(mean, table):
    return PolicyLibrary.from_means(mean, 1.0, signal=CategorySignal(table.probs.transpose(1, 0, 2)))


# ---- the choice ----------------------------------------------------------------------------------------------


@settings(deadline=None, max_examples=60)
@given(seeds, st.sampled_from([MASS, 1.0]))
def test_rules_choose_as_by_exact_scores_in_float32_and_by_tangents(seed, mass):
    random = np.random.default_rng(seed)
    mean, table = any_size(random)
    library, belief = library_of(mean, table), beliefs(random, len(mean))
    rules = [BeliefEntropy(mass=mass), InformationDirected(mass=mass)]
    exact = [rule.scores(library, belief[None])[0] for rule in rules]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(signal_rows, "LEAST_NUMBERS", 1)
        for rule, scores in zip(rules, exact, strict=True):
            assert_same_choice(rule.scores(library, belief), scores)
        patch.setattr(knowledge_gradient, "EXACT_WORK", 0)
        for module in MODULES:
            patch.setattr(module, "MOST_NUMBERS", 0)
        again = library_of(mean, table)
        for rule, scores in zip(rules, exact, strict=True):
            found = rule.scores(again, belief)
            assert_same_choice(found, scores)
            # A ratio to a gain of 1e-8 nats has the rounding of that difference of entropies.
            assert (found >= scores - 1e-9 * np.abs(scores).max() - 1e-7 * np.abs(scores)).all()


def assert_same_choice(found, exact):
    assert np.array_equal(tied_shares(found) > 0, tied_shares(exact) > 0)
    assert found.max() == pytest.approx(exact.max(), rel=1e-3, abs=1e-3)


@settings(deadline=None, max_examples=60)
@given(seeds, st.sampled_from([MASS, 1.0]), st.sampled_from(["all", "responses"]))
def test_knowledge_gradients_in_float32_choose_as_exact_ones(seed, mass, candidates):
    random = np.random.default_rng(seed)
    mean, table = any_size(random)
    belief, weight = beliefs(random, len(mean)), float(random.choice([0.0, 1.0, 50.0]))
    exact = belief @ mean + weight * knowledge_gain(belief, mean, table, mass, candidates)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(signal_rows, "LEAST_NUMBERS", 1)
        found = knowledge_scores(belief, mean, table, weight, mass, candidates)
    assert np.array_equal(tied_shares(found) > 0, tied_shares(exact) > 0)
    assert found == pytest.approx(exact, abs=1e-5 * (1 + weight) * np.ptp(mean) + 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("n_beliefs", [2_000, pytest.param(10_000, marks=pytest.mark.soak)])
def test_choices_of_random_beliefs_at_the_size_of_the_reserve(n_beliefs):
    random = np.random.default_rng(3)
    means = random.normal(scale=60, size=(40, 40))
    library = PolicyLibrary.from_samples(means[..., None] + 20 * random.standard_normal((40, 40, 10)))
    table, mean = library.table(24), library.performance.mean
    assert signal_rows.signal_rows(table) is not None
    gradient = KnowledgeGradient(n_bins=24)
    rules = [BeliefEntropy(n_bins=24), InformationDirected(n_bins=24)]
    for number in range(n_beliefs):
        belief = beliefs(random, 40)
        for rule in rules:
            exact = rule.scores(library, belief[None])[0]
            assert rule.scores(library, belief).argmax() == exact.argmax()
        if number % 10 == 0:
            exact = belief @ mean + 7 * knowledge_gain(belief, mean, table, MASS, "auto")
            assert gradient.scores(library, belief, episodes_left=7).argmax() == exact.argmax()


def test_policies_that_are_alike_tie(single):
    mean, table = learnt(np.random.default_rng(0), 6, 3, 5)
    twice, laws = np.hstack([mean, mean]), SignalTable(np.concatenate([table.probs, table.probs]))
    library, belief = library_of(twice, laws), np.full(6, 1 / 6)
    for rule in (BeliefEntropy(), InformationDirected(), KnowledgeGradient(candidates="all")):
        shares = rule.probabilities(library, belief, episodes_left=9)
        assert shares.max() == 0.5, rule
        assert shares[:3] == pytest.approx(shares[3:])


# ---- the bounds ----------------------------------------------------------------------------------------------


@settings(deadline=None, max_examples=60)
@given(seeds, st.sampled_from([MASS, 1.0]))
def test_bounds_hold(seed, mass):
    random = np.random.default_rng(seed)
    mean, table = any_size(random)
    belief = beliefs(random, len(mean))
    support, share = supported_types(belief, mass)
    rows = signal_rows.SignalRows(
        np.ascontiguousarray(table.probs.transpose(1, 0, 2), np.float32).reshape(table.n_types, -1),
        table.n_policies,
        table.n_signals,
    )
    exact = mutual_information(belief, table, mass)
    upper, width = rounded_bound(support, share, expected_noise(support, share, table), rows)
    assert (upper >= exact).all()
    assert (np.maximum(upper - width, 0) <= exact).all()
    assert (tangent_bound(support, share, table) >= exact).all()
    gain = knowledge_gain(belief, mean, table, mass)
    found, error = rounded_gain(support, mean[support] * share[:, None], rows)
    assert np.abs(found - gain).max() <= error + 1e-12 * np.abs(mean).max()
    joined = joined_gain(support, mean[support] * share[:, None], table)
    assert (joined <= gain + 1e-5 * np.ptp(mean) + 1e-9).all()


def test_a_tangent_touches_at_the_flat_belief():
    _, table = learnt(np.random.default_rng(1), 40, 6, 9)
    flat = np.full(40, 1 / 40)
    bound = tangent_bound(np.arange(40), flat, table)
    assert bound == pytest.approx(mutual_information(flat, table), abs=1e-4)
    one = np.eye(40)[3]
    assert (tangent_bound(*supported_types(one, 1.0), table) > 0.1).all()


def test_joined_signals_that_lose_nothing_keep_the_gain():
    random = np.random.default_rng(2)
    mean, table = learnt(random, 8, 4, 3)
    # Each signal split into three of equal likelihood ratios.
    split = SignalTable(np.repeat(table.probs, 3, axis=2) / 3)
    belief = beliefs(random, 8)
    support, share = supported_types(belief, 1.0)
    found = joined_gain(support, mean[support] * share[:, None], split)
    assert found == pytest.approx(knowledge_gain(belief, mean, table), abs=1e-4)


def test_exact_best_computes_no_more_than_it_needs():
    truth = np.array([1.0, 5.0, 4.0, 3.0, 5.0])
    asked = []

    def exact(policies):
        asked.extend(policies.tolist())
        return truth[policies]

    assert exact_best(truth + 0.1, 4.95, exact).tolist() == [1.1, 5.0, 4.1, 3.1, 5.0]
    assert asked == [1, 4]
    asked.clear()
    only = np.array([1.0, 9.0, 2.0])
    assert exact_best(only, 5.0, exact) is only
    assert not asked
    many = np.arange(100.0)
    found = exact_best(many + 0.5, -np.inf, lambda policies: many[policies])
    assert found.tolist() == [*(many[:68] + 0.5), *many[68:]]


# ---- large tables --------------------------------------------------------------------------------------------


def test_the_gradient_of_a_large_table_is_exact_where_it_matters(large, monkeypatch):
    random = np.random.default_rng(5)
    mean, table = learnt(random, 30, 50, 12)
    belief = random.dirichlet(np.ones(30))
    laws = table.probs.tolist()
    support = supported_types(belief, MASS)[0]
    cut = np.zeros(30)
    cut[support] = belief[support] / belief[support].sum()
    exact = belief @ mean + 9 * np.array(naive.knowledge_gain(cut.tolist(), mean.tolist(), laws))
    scores = knowledge_scores(belief, mean, table, 9.0, MASS)
    same = np.abs(scores - exact) < 1e-8
    assert same.sum() >= knowledge_gradient.LEAST_EXACT
    assert same[scores.argmax()]
    assert (scores <= exact + 1e-3).all()
    monkeypatch.setattr(knowledge_gradient, "LEAST_EXACT", 50)
    assert knowledge_scores(belief, mean, table, 9.0, MASS) == pytest.approx(exact, abs=1e-8)


@pytest.mark.parametrize("size", ["single", "large"])
def test_rows_that_a_task_replaces_are_seen(size, request):
    request.getfixturevalue(size)
    random = np.random.default_rng(7)
    mean, table = learnt(random, 9, 6, 10)
    _, other = learnt(random, 9, 6, 10)
    changed = table.copy()
    belief = random.dirichlet(np.ones(9))

    def scores(of):
        found = information_bounds.scores_by_information(belief, of, MASS, lambda known, some: known)
        return np.array([found, knowledge_scores(belief, mean, of, 3.0, MASS)])

    first = scores(changed)
    assert np.array_equal(first, scores(table))
    changed.replace(2, other.probs[2].copy())
    changed.replace(4, other.probs[4].copy())
    fresh = SignalTable.restored(changed.probs.copy())
    assert np.array_equal(scores(changed), scores(fresh))
    assert not np.array_equal(scores(changed), first)
    assert np.array_equal(scores(table), first)


# ---- odd tables and beliefs ----------------------------------------------------------------------------------


@pytest.mark.parametrize(("n_types", "n_policies", "n_signals"), [(1, 4, 3), (4, 1, 3), (1, 1, 2), (3, 2, 1)])
@pytest.mark.parametrize("size", ["single", "large"])
def test_one_type_one_policy_one_signal(n_types, n_policies, n_signals, size, request):
    request.getfixturevalue(size)
    mean, table = learnt(np.random.default_rng(0), n_types, n_policies, n_signals)
    belief = np.eye(n_types)[0]
    information = mutual_information(belief, table)
    assert information == pytest.approx(np.zeros(n_policies), abs=1e-12)
    assert knowledge_scores(belief, mean, table, 5.0) == pytest.approx(mean[0], abs=1e-4)
    found = information_bounds.scores_by_information(belief, table, MASS, lambda known, some: known)
    assert found == pytest.approx(np.zeros(n_policies), abs=1e-4)


@pytest.mark.parametrize("scale", [1e-80, 1.0, 1e80])
def test_means_of_any_size_and_beliefs_near_zero(single, scale):
    random = np.random.default_rng(4)
    mean, table = learnt(random, 9, 6, 7)
    belief = 10.0 ** -np.array([0, 1, 30, 100, 200, 300, 307, 310, 320])
    belief /= belief.sum()
    with np.errstate(under="ignore"):
        exact = belief @ mean + 5 * knowledge_gain(belief, mean, table)
        found = knowledge_scores(belief, mean * scale, table, 5.0)
    assert found / scale == pytest.approx(exact, abs=1e-3)
    assert np.isfinite(BeliefEntropy(mass=1.0).scores(library_of(mean, table), belief)).all()


@pytest.mark.slow
@pytest.mark.parametrize("n_beliefs", [10_000, pytest.param(100_000, marks=pytest.mark.soak)])
def test_random_beliefs_give_numbers(n_beliefs, single):
    random = np.random.default_rng(6)
    mean, table = learnt(random, 12, 6, 5, np.float32)
    library = library_of(mean, table)
    rules = [BeliefEntropy(mass=1.0), InformationDirected(), KnowledgeGradient()]
    for number in range(n_beliefs):
        belief = beliefs(random, 12)
        assert np.isfinite(rules[number % 3].scores(library, belief, episodes_left=3)).all()


WITHOUT = """
import sys
import numpy as np
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection import rule_named
from lifelore.interaction.finite_signals.signal_table import SignalTable
random = np.random.default_rng(0)
library = PolicyLibrary.from_means(random.normal(size=(70, 60)) * 9, 2.0)
library.keep_table(8, SignalTable.restored(random.dirichlet(np.ones(8), (60, 70))))
for name in ("belief-entropy", "information-directed", "knowledge-gradient"):
    rule_named(name).probabilities(library, random.dirichlet(np.ones(70)))
print([name for name in ("numba", "scipy") if name in sys.modules])
"""


@pytest.mark.slow
def test_a_single_decision_needs_no_compiler():
    done = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
