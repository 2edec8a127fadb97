"""Rules for selecting: each beside its plain twin, by hand, in batches, cut down by mass, and among equals."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import norm

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.beliefs.belief import entropy
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection import (
    RULES,
    BeliefEntropy,
    BeliefSampling,
    EpsilonGreedy,
    ExpectedImprovement,
    Greedy,
    InformationDirected,
    KnowledgeGradient,
    ProbabilityOfImprovement,
    ValueOfPerfectInformation,
    choose,
    rule_named,
    tied_shares,
)
from lifelore.interaction.selection import rule as rule_module
from lifelore.interaction.selection.information import expected_entropy, mutual_information
from lifelore.interaction.selection.information_kernels import best_after_signals, class_mixtures, mixtures
from lifelore.interaction.selection.knowledge_gradient import knowledge_gain, responses
from lifelore.interaction.selection.support import supported_types, truncated
from lifelore.interaction.selection.type_classes import type_classes
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal

from ..twins import naive_rules as naive

INF = math.inf
EVERY_RULE = [
    *(rule() for rule in RULES.values()),
    BeliefEntropy(variant="thesis"),
    ExpectedImprovement("thesis"),
    ExpectedImprovement(of="outcome"),
    KnowledgeGradient("thesis"),
    KnowledgeGradient(candidates="all", mass=1.0),
    ValueOfPerfectInformation("once"),
    ProbabilityOfImprovement(variant="thesis"),
]


def problem(seed: int, n_types: int = 5, n_policies: int = 4, n_signals: int = 6):
    """A library with categories for signals, some of them impossible, and a belief with a type ruled out."""
    random = np.random.default_rng(seed)
    mean, deviation = (
        random.normal(scale=50, size=(n_types, n_policies)),
        random.uniform(5, 30, (n_types, n_policies)),
    )
    probs = random.dirichlet(np.full(n_signals, 0.4), (n_types, n_policies))
    probs[random.random(probs.shape) < 0.2] = 0
    probs[..., 0] += 1e-3
    probs /= probs.sum(axis=2, keepdims=True)
    library = PolicyLibrary.from_means(mean, deviation, signal=CategorySignal(probs))
    belief = random.dirichlet(np.full(n_types, 0.7))
    belief[random.integers(n_types)] = 0
    return library, belief / belief.sum()


def as_lists(library):
    model = library.performance
    return model.mean.tolist(), model.deviation.tolist(), library.table(8).probs.tolist()


# ---- twins ---------------------------------------------------------------------------------------------------


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 2**32 - 1))
def test_every_rule_agrees_with_its_plain_twin(seed):
    library, belief = problem(seed)
    mean, deviation, laws = as_lists(library)
    b = belief.tolist()
    now = naive.utilities(b, mean)
    assert Greedy().scores(library, belief) == pytest.approx(now)
    assert ExpectedImprovement().scores(library, belief) == pytest.approx(naive.mean_improvement(b, mean))
    assert ExpectedImprovement(of="outcome").scores(library, belief) == pytest.approx(
        naive.expected_improvement(b, mean, deviation), rel=1e-6, abs=1e-7
    )
    top = max(max(row) for weight, row in zip(b, mean, strict=True) if weight > 0)
    for target in (None, 17.0):
        assert ProbabilityOfImprovement(target).scores(library, belief) == pytest.approx(
            naive.probability_above(b, mean, deviation, top if target is None else target)
        )
    scores = BeliefEntropy(kappa=40.0, mass=1.0).scores(library, belief)
    assert scores - 40 * entropy(belief) == pytest.approx(naive.belief_entropy(b, mean, laws, 40.0))
    gained = np.array(naive.knowledge_gain(b, mean, laws))
    for candidates in ("auto", "all"):
        scores = KnowledgeGradient(mass=1.0, candidates=candidates).scores(library, belief, episodes_left=7)
        assert scores == pytest.approx(now + 7 * gained, abs=1e-9)
    perfect = np.array(naive.perfect_gain(b, mean))
    for counted, weight in (("episodes", 7), ("once", 1)):
        scores = ValueOfPerfectInformation(counted).scores(library, belief, episodes_left=7)
        assert scores == pytest.approx(now + weight * perfect, abs=1e-9)
    ratio = naive.information_ratio(b, mean, laws)
    assert InformationDirected(mass=1.0).scores(library, belief) ** 2 == pytest.approx(ratio, rel=1e-5)


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 2**32 - 1))
def test_every_printed_form_agrees_with_its_plain_twin(seed):
    library, belief = problem(seed)
    mean, deviation, laws = as_lists(library)
    b = belief.tolist()
    now = naive.utilities(b, mean)
    assert ExpectedImprovement("thesis").scores(library, belief) == pytest.approx(
        naive.probability_above(b, mean, deviation, max(now))
    )
    assert ProbabilityOfImprovement(variant="thesis", margin=3.0).scores(library, belief) == pytest.approx(
        naive.density_at(b, mean, deviation, max(now) + 3.0)
    )
    printed = [naive.entropy(naive.printed_posterior(b, law)) for law in laws]
    assert BeliefEntropy(20.0, "thesis").scores(library, belief) == pytest.approx(
        np.array(now) - 20 * np.array(printed)
    )
    gained = np.array(naive.printed_gain(b, mean, laws))
    assert KnowledgeGradient("thesis").scores(library, belief, episodes_left=7) == pytest.approx(now + 7 * gained)


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 2**32 - 1), st.integers(2, 9), st.integers(2, 12))
def test_expected_entropy_two_ways(seed, n_types, n_signals):
    library, belief = problem(seed, n_types, 3, n_signals)
    table = library.table(16)
    direct = naive.expected_entropy(belief.tolist(), table.probs.tolist())
    assert expected_entropy(belief, table) == pytest.approx(direct, abs=1e-12)
    assert (mutual_information(belief, table) >= 0).all()
    assert (mutual_information(belief, table) <= entropy(belief) + 1e-12).all()


def test_the_kernels_by_hand():
    probs = np.array([[[1.0, 0.0], [0.5, 0.5]], [[0.0, 1.0], [0.25, 0.75]]])
    mixed = np.empty((2, 2))
    mixtures(np.array([0.2, 0.8]), np.array([0, 1]), np.array([0, 1]), probs, mixed)
    assert mixed == pytest.approx(np.array([[0.6, 0.4], [0.2, 0.8]]))
    mixtures(np.array([1.0]), np.array([1]), np.array([0, 1]), probs, mixed)
    assert mixed == pytest.approx(probs[:, 1])
    best = np.empty(2)
    # Two candidates worth 1 on their own type: the larger joint of each signal, summed.
    alone, both = np.array([[0, 1], [0, 1]], np.int32), np.array([2, 2])
    best_after_signals(np.diag([0.2, 0.8]), np.array([0, 1]), alone, both, np.array([0, 1]), probs, best)
    assert best == pytest.approx([max(0.2, 0.4) + 0.4, max(0.0, 0.2) + max(0.2, 0.6)])
    best_after_signals(np.array([[0.0, 3.0]]), np.array([1]), alone, both, np.array([0, 1]), probs, best)
    assert best == pytest.approx([3.0, 3.0])


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 2**32 - 1), st.sampled_from([1.0, 0.9]))
def test_types_that_a_policy_cannot_tell_apart_count_as_one(seed, mass):
    random = np.random.default_rng(seed)
    patterns = random.dirichlet(np.full(4, 0.5), (5, 3))
    which = random.integers(0, 3, (5, 9))
    which[4] = np.arange(9) % 2
    probs = np.stack([patterns[policy][which[policy]] for policy in range(5)])
    table, mean = SignalTable(probs), random.normal(scale=20, size=(9, 5))
    classes = type_classes(table)
    assert classes.few
    assert classes.number.max() <= 3
    for policy in range(5):
        same = which[policy][:, None] == which[policy]
        assert np.array_equal(classes.of_type[policy][:, None] == classes.of_type[policy], same)
    assert type_classes(table) is classes
    belief = random.dirichlet(np.full(9, 0.5))
    cut = truncated(belief[None], mass)[0].tolist()
    laws = table.probs.tolist()
    assert entropy(np.array(cut)) - mutual_information(belief, table, mass) == pytest.approx(
        naive.expected_entropy(cut, laws), abs=1e-9
    )
    assert knowledge_gain(belief, mean, table, mass) == pytest.approx(
        naive.knowledge_gain(cut, mean.tolist(), laws), abs=1e-9
    )


def test_laws_that_only_look_alike_are_told_apart(monkeypatch):
    laws = np.array([[[0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]]])
    mark = "lifelore.interaction.selection.type_classes.stream"
    monkeypatch.setattr(mark, lambda *_: type("Flat", (), {"random": staticmethod(np.ones)}))
    classes = type_classes(SignalTable(laws))
    assert classes.number.tolist() == [2]
    assert classes.of_type[0, 0] == classes.of_type[0, 2] != classes.of_type[0, 1]


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 2**32 - 1), st.integers(1, 13))
def test_mixtures_of_any_number_of_types(seed, n_kept):
    random = np.random.default_rng(seed)
    probs, kept = random.dirichlet(np.ones(5), (3, 13)), np.sort(random.permutation(13)[:n_kept])
    share, mixed = random.dirichlet(np.ones(n_kept)), np.empty((3, 5))
    mixtures(share, kept, np.arange(3), probs, mixed)
    assert mixed == pytest.approx(np.einsum("t,pts->ps", share, probs[:, kept]))
    apart = np.tile(np.arange(13, dtype=np.int32), (3, 1))
    class_mixtures(share, kept, apart, np.arange(3), probs, mixed)
    assert mixed == pytest.approx(np.einsum("t,pts->ps", share, probs[:, kept]))


# ---- by hand -------------------------------------------------------------------------------------------------


def test_the_knowledge_gradient_pays_for_a_perfect_signal():
    # Two types; the third policy earns little but tells which. Knowing is worth 10 - 5 an episode.
    probs = np.array([[[0.5, 0.5], [0.5, 0.5], [1, 0]], [[0.5, 0.5], [0.5, 0.5], [0, 1]]], float)
    library = PolicyLibrary.from_means([[10, 0, 1], [0, 10, 1]], 1.0, signal=CategorySignal(probs))
    flat = np.array([0.5, 0.5])
    assert knowledge_gain(flat, library.performance.mean, library.table()) == pytest.approx([0.0, 0.0, 5.0])
    rule = KnowledgeGradient()
    assert choose(rule.scores(library, flat, episodes_left=2), np.random.default_rng(0)) == 2
    assert choose(rule.scores(library, flat, episodes_left=0), np.random.default_rng(0)) in (0, 1)
    assert mutual_information(flat, library.table()) == pytest.approx([0.0, 0.0, math.log(2)])


def test_improvement_of_the_pay_by_hand():
    # Now policy 0 is best, with 8. It pays 2 more on type 0; policy 1 pays 12 more on type 1.
    library = PolicyLibrary.from_means([[10.0, 0.0], [2.0, 20.0]], [[1.0, 500.0], [30.0, 7.0]])
    belief = np.array([0.75, 0.25])
    assert ExpectedImprovement().scores(library, belief).tolist() == [1.5, 3.0]
    # Noise changes nothing of it, unlike of the improvement of the outcome.
    loud = PolicyLibrary.from_means(library.performance.mean, 1e4)
    assert ExpectedImprovement().scores(loud, belief).tolist() == [1.5, 3.0]
    assert ExpectedImprovement(of="outcome").scores(loud, belief).min() > 1e3


def test_perfect_information_by_hand():
    # A pays 5 on both types, B 0 or 8, C 2 or 3: 5, 4 and 2.5 are expected.
    library = PolicyLibrary.from_means([[5.0, 0.0, 2.0], [5.0, 8.0, 3.0]], 1.0)
    rule, belief = ValueOfPerfectInformation(lookahead=4.0), np.array([0.5, 0.5])
    # Half of the time B turns out 3 above A; A and C are never known to change the choice.
    assert rule.scores(library, belief).tolist() == [5.0, 4.0 + 4 * 1.5, 2.5]
    assert rule.scores(library, belief, episodes_left=0).tolist() == [5.0, 4.0, 2.5]
    # The best policy is known to be bad half of the time: then the second best is chosen, which pays 4 more.
    risky = PolicyLibrary.from_means([[0.0, 4.0], [10.0, 4.0]], 1.0)
    assert rule.scores(risky, belief).tolist() == [5.0 + 4 * 2.0, 4.0]
    assert rule.scores(PolicyLibrary.from_means([[3.0], [5.0]], 1.0), belief).tolist() == [4.0]


def test_perfect_information_about_uncertain_means_agrees_with_an_integral():
    samples = np.random.default_rng(3).normal([[10, 13, 9], [14, 8, 12]], 4.0, (6, 2, 3)).transpose(1, 2, 0)
    task = PolicyLibrary.from_samples(samples).for_task()
    task.performance.learn(1, 11.0)
    model, belief = task.performance, np.array([0.3, 0.7])
    now = belief @ model.mean
    found = ValueOfPerfectInformation("once").scores(task, belief) - now
    for policy in range(3):
        other = np.delete(now, policy).max()
        means = [norm(model.mean[t, policy], model.mean_variance[t, policy] ** 0.5) for t in range(2)]
        known = sum(b * law.expect(lambda m, o=other: max(m, o)) for b, law in zip(belief, means, strict=True))
        assert found[policy] == pytest.approx(known - now.max(), rel=1e-4)
        assert found[policy] > 0


@pytest.mark.parametrize("noise", [1.0, 1e3])
def test_without_an_improvement_of_the_pay_selection_is_greedy(noise):
    mean = np.array([[3.0, 7.0, 7.0, 1.0], [7.0, 7.0, 2.0, 0.0], [90.0, 5.0, 0.0, 90.0]])
    library = PolicyLibrary.from_means(mean, noise * np.arange(1, 13.0).reshape(3, 4))
    rule = ExpectedImprovement()
    # A certain type; two types with one best policy; a better type that is all but ruled out.
    none = np.array([[1.0, 0, 0], [0, 1.0, 0], [0.4, 0.6, 0], [1 - 1e-12, 0, 1e-12]])
    some = np.array([0.5, 0.0, 0.5])
    rows = np.stack([none[0], some, none[1], some, none[2], none[3]])
    shares = rule.probabilities(library, rows)
    assert np.array_equal(shares[[0, 2, 4, 5]], Greedy().probabilities(library, none))
    assert shares[0].tolist() == [0, 0.5, 0.5, 0]
    assert shares[4].tolist() == [0, 1, 0, 0]
    for row, share in zip(rows, shares, strict=True):
        assert np.array_equal(rule.probabilities(library, row), share)
    # Where a pay can improve, the score is the improvement: here policies 0 and 3 on type 2 alone.
    best = 0.5 * 3 + 0.5 * 90
    assert rule.scores(library, some).tolist() == [0.5 * (90 - best), 0, 0, 0.5 * (90 - best)]


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 2**32 - 1), st.integers(1, 6))
def test_a_known_type_gets_its_best_policy_whatever_the_noise(seed, n_types):
    random = np.random.default_rng(seed)
    mean = random.normal(scale=10, size=(n_types, 5)) + random.choice([0.0, 1e6])
    library = PolicyLibrary.from_means(mean, np.exp(random.normal(scale=3, size=mean.shape)))
    for type_ in range(n_types):
        shares = ExpectedImprovement().probabilities(library, np.eye(n_types)[type_])
        assert shares[mean[type_].argmax()] == 1


def test_a_policy_that_is_second_best_everywhere_is_seen_with_all_candidates():
    # Three types, each with a policy of its own, and one that is good on all. The last tells type 0 from the
    # others.
    mean = np.array([[10, 0, 0, 8, 0], [0, 10, 0, 8, 0], [0, 0, 10, 8, 0]], float)
    probs = np.full((3, 5, 2), 0.5)
    probs[:, 4] = [[1, 0], [0, 1], [0, 1]]
    table = SignalTable(probs.transpose(1, 0, 2))
    belief = np.array([0.98, 0.01, 0.01])
    # Now policy 0 is best, at 9.8; after "not type 0" it is policy 3 with 8, against 5 for the others' own.
    assert knowledge_gain(belief, mean, table)[4] == pytest.approx(0.98 * 10 + 0.02 * 8 - 9.8)
    assert knowledge_gain(belief, mean, table, candidates="responses")[4] == pytest.approx(0.02 * 5)
    assert responses(mean, belief).tolist() == [0, 1, 2]


def test_small_libraries_consider_all_policies_and_large_ones_the_best_responses(monkeypatch):
    # Types, policies, signals: 7 · 9² · 6 products.
    wrong = 0
    for seed in range(60):
        library, belief = problem(seed, 7, 9, 6)
        mean, table = library.performance.mean, library.table()
        exact = np.array(naive.knowledge_gain(belief.tolist(), mean.tolist(), table.probs.tolist()))
        own = responses(mean[belief > 0], belief[belief > 0]).tolist()
        shortcut = naive.knowledge_gain(belief.tolist(), mean.tolist(), table.probs.tolist(), own)
        monkeypatch.setattr("lifelore.interaction.selection.knowledge_gradient.LARGEST_EXACT", 7 * 9**2 * 6)
        assert knowledge_gain(belief, mean, table, 1.0, "auto") == pytest.approx(exact, abs=1e-9)
        monkeypatch.setattr("lifelore.interaction.selection.knowledge_gradient.LARGEST_EXACT", 7 * 9**2 * 6 - 1)
        assert knowledge_gain(belief, mean, table, 1.0, "auto") == pytest.approx(shortcut, abs=1e-9)
        wrong += bool((np.abs(exact - shortcut) > 1e-6).any())
    # The shortcut leaves out policies that are second best on many types: in most of these libraries some score.
    assert wrong > 10


def test_epsilon_greedy_and_sampling_select_as_often_as_they_say():
    library, belief = problem(3)
    for rule in (EpsilonGreedy(0.4), BeliefSampling()):
        stated = rule.probabilities(library, belief)
        assert stated.sum() == pytest.approx(1)
        random = np.random.default_rng(0)
        drawn = [choose(rule.scores(library, belief, generator=random), random) for _ in range(4000)]
        many = choose(rule.scores(library, np.tile(belief, (4000, 1)), generator=random), random)
        for found in (drawn, many):
            # The deviation of a share of 4000 is at most 0.5 / √4000 = 0.0079; five of them.
            assert np.bincount(found, minlength=4) / 4000 == pytest.approx(stated, abs=0.04)


def test_sampling_never_draws_what_is_ruled_out():
    library = PolicyLibrary.from_means(np.eye(3), 1.0)
    random = np.random.default_rng(0)
    for belief in ([0.0, 0.5, 0.5], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5]):
        seen = {
            choose(BeliefSampling().scores(library, np.array(belief), generator=random), random) for _ in range(60)
        }
        assert seen == set(np.flatnonzero(belief).tolist())


# ---- batches, mass, precision --------------------------------------------------------------------------------


@pytest.mark.parametrize("rule", EVERY_RULE, ids=repr)
def test_many_beliefs_are_scored_as_one_by_one(rule, monkeypatch):
    monkeypatch.setattr(rule_module, "NUMBERS_AT_ONCE", 100)
    library = problem(5, 7, 6)[0]
    beliefs = np.random.default_rng(1).dirichlet(np.full(7, 0.3), (2, 6))
    if rule.name in ("epsilon-greedy", "sampling"):
        found = rule.scores(library, beliefs, generator=np.random.default_rng(0))
        assert found.shape == (2, 6, 6)
    else:
        found = rule.scores(library, beliefs, episodes_left=4)
        alone = np.array([[rule.scores(library, belief, episodes_left=4) for belief in row] for row in beliefs])
        assert found == pytest.approx(alone, rel=1e-12, abs=1e-12 * np.abs(alone).max())
    shares = rule.probabilities(library, beliefs, episodes_left=4)
    assert shares.shape == (2, 6, 6)
    assert shares.sum(axis=-1) == pytest.approx(np.ones((2, 6)))
    assert shares[1, 2] == pytest.approx(rule.probabilities(library, beliefs[1, 2], episodes_left=4))


def test_support_holds_its_mass_and_no_fixed_number():
    belief = np.array([0.6, 0.3, 0.0, 0.09, 0.01])
    kept, share = supported_types(belief, 0.95)
    assert kept.tolist() == [0, 1, 3]
    assert share == pytest.approx(belief[kept] / 0.99)
    assert supported_types(belief, 1.0)[0].tolist() == [0, 1, 3, 4]
    # A flat belief keeps everything: types exactly as likely as the last one taken are taken too.
    assert len(supported_types(np.full(5000, 1 / 5000), 0.5)[0]) == 5000
    assert supported_types(np.array([0.0, 1.0]), 0.999)[0].tolist() == [1]


@settings(deadline=None, max_examples=40)
@given(st.integers(1, 40), st.floats(0.05, 3.0), st.floats(0.5, 1.0), st.integers(0, 2**32 - 1))
def test_support_is_as_small_as_can_be(n_types, spread, mass, seed):
    belief = np.random.default_rng(seed).dirichlet(np.full(n_types, spread))
    kept = supported_types(belief, mass)[0]
    assert belief[kept].sum() >= mass - 1e-12
    least = belief[kept].min()
    assert belief[belief > least].sum() < mass + 1e-12 or len(kept) == 1
    rows = truncated(np.stack([belief, belief[::-1]]), mass)
    assert np.flatnonzero(rows[0]).tolist() == kept.tolist()
    assert rows.sum(axis=1) == pytest.approx([1, 1])


def test_cutting_down_by_mass_moves_little_and_by_number_much():
    library = problem(8, 60, 10, 8)[0]
    belief = np.random.default_rng(0).dirichlet(np.full(60, 0.15))
    mean, table = library.performance.mean, library.table()
    exact = knowledge_gain(belief, mean, table)
    span = np.ptp(mean)
    kept = supported_types(belief, 1 - 1e-3)[0]
    assert 5 < len(kept) < 60
    # What was left out holds 1/1000 of the belief, and no utility differs by more than the span.
    assert knowledge_gain(belief, mean, table, 1 - 1e-3) == pytest.approx(exact, abs=4e-3 * span)
    assert mutual_information(belief, table, 1 - 1e-3) == pytest.approx(
        mutual_information(belief, table), abs=2e-3 * math.log(60) + 8e-3
    )


def test_tables_in_float32_agree_to_their_precision():
    library, belief = problem(4, 9, 7, 8)
    mean, table = library.performance.mean, library.table()
    half = SignalTable(table.probs.astype(np.float32))
    assert half.probs.dtype == np.float32
    assert mutual_information(belief, half) == pytest.approx(mutual_information(belief, table), abs=1e-5)
    assert mutual_information(belief[None], half)[0] == pytest.approx(mutual_information(belief, half), abs=1e-5)
    span = np.ptp(mean)
    assert knowledge_gain(belief, mean, half) == pytest.approx(
        knowledge_gain(belief, mean, table), abs=1e-5 * span
    )


# ---- among equals --------------------------------------------------------------------------------------------


def test_equals_are_chosen_evenly_and_by_the_generator():
    scores = np.array([1.0, 3.0, 3.0 * (1 + 1e-12), -INF, 3.0])
    assert tied_shares(scores) == pytest.approx([0, 1 / 3, 1 / 3, 0, 1 / 3])
    drawn = [choose(scores, np.random.default_rng(seed)) for seed in range(3000)]
    # Deviation of a third of 3000: √(3000 · 2/9) = 26; five of them.
    assert np.bincount(drawn, minlength=5) == pytest.approx([0, 1000, 1000, 0, 1000], abs=130)
    assert [choose(scores, np.random.default_rng(7)) for _ in range(3)] == [drawn[7]] * 3
    rows = choose(np.tile(scores, (3000, 1)), np.random.default_rng(0))
    assert np.bincount(rows, minlength=5) == pytest.approx([0, 1000, 1000, 0, 1000], abs=130)


def test_a_choice_without_equals_asks_for_no_random_number():
    random = np.random.default_rng(0)
    before = random.bit_generator.state
    assert choose([0.0, 2.0, 1.0], random) == 1
    assert random.bit_generator.state == before


@pytest.mark.parametrize(
    ("scores", "shares"),
    [
        ([INF, 1.0, INF], [0.5, 0, 0.5]),
        ([-INF, -INF], [0.5, 0.5]),
        ([-INF, -5.0], [0, 1]),
        ([0.0, -1e-17, -1.0], [0.5, 0.5, 0]),
        ([-1e-12, -2e-12], [1, 0]),
        ([5.0], [1]),
        ([-INF, 2.0, -INF, 2.0, 1.0], [0, 0.5, 0, 0.5, 0]),
    ],
)
def test_choices_at_the_ends_of_the_range(scores, shares):
    assert tied_shares(scores).tolist() == shares
    assert shares[choose(scores, np.random.default_rng(0))] > 0


def test_nan_and_nothing_are_refused():
    for scores in ([1.0, math.nan], []):
        with pytest.raises(InputError, match="got NaN or nothing"):
            choose(scores, np.random.default_rng(0))
    with pytest.raises(InputError, match="got NaN or nothing"):
        choose([[1.0, 2.0], [1.0, math.nan]], np.random.default_rng(0))
    with pytest.raises(InputError, match="got NaN"):
        tied_shares([1.0, math.nan])


def test_a_flat_belief_over_symmetric_types_ties_all_policies():
    library = PolicyLibrary.from_means(np.eye(6) * 7.3 - 2.1, 3.0)
    flat = np.full(6, 1 / 6)
    for name in RULES:
        assert rule_named(name).probabilities(library, flat) == pytest.approx(np.full(6, 1 / 6)), name


# ---- bad settings --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: EpsilonGreedy(1.2), "epsilon must lie in"),
        (lambda: ExpectedImprovement("printed"), "variant must be"),
        (lambda: ExpectedImprovement(of="reward"), "of must be 'pay'"),
        (lambda: ProbabilityOfImprovement(target=math.nan), "target must be finite"),
        (lambda: ProbabilityOfImprovement(margin=0.0), "margin must be positive"),
        (lambda: BeliefEntropy(kappa=-1.0), "kappa must be at least 0"),
        (lambda: BeliefEntropy(mass=0.0), "mass must lie in"),
        (lambda: KnowledgeGradient(lookahead=INF), "lookahead must be at least 0"),
        (lambda: KnowledgeGradient(candidates="some"), "candidates must be"),
        (lambda: ValueOfPerfectInformation("always"), "counted must be 'episodes'"),
        (lambda: ValueOfPerfectInformation(lookahead=-1.0), "lookahead must be at least 0"),
        (lambda: InformationDirected(mass=1.5), "mass must lie in"),
    ],
)
def test_settings_that_break_their_rule_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_unknown_rules_and_missing_generators_are_named():
    with pytest.raises(NotFoundError, match="rule must be one of greedy"):
        rule_named("best")
    library, belief = problem(0)
    for rule in (BeliefSampling(), EpsilonGreedy()):
        with pytest.raises(InputError, match="give a generator"):
            rule.scores(library, belief)


def test_rules_that_look_ahead_need_signals_that_can_be_listed():
    library = PolicyLibrary.from_means(np.eye(2), 1.0, signal=LikelihoodSignal(lambda p, s: [0.0, 0.0], 2))
    for rule in (BeliefEntropy(), KnowledgeGradient(), InformationDirected()):
        with pytest.raises(InputError, match="no finite alphabet"):
            rule.scores(library, library.prior)


def test_every_rule_is_registered_under_its_name():
    assert all(rule.name == name for name, rule in RULES.items())
    assert len(RULES) == 9
