"""Rules for selecting: each beside its plain twin, for many users, and cut down by mass."""

import math
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.selection import (
    DEFAULT_RULE,
    RULES,
    WITHOUT_TABLE,
    BeliefEntropy,
    BeliefSampling,
    EpsilonGreedy,
    ExpectedImprovement,
    Greedy,
    InformationDirected,
    KnowledgeGradient,
    ProbabilityOfImprovement,
    ValueOfPerfectInformation,
    propensities,
    rule_named,
    rule_of,
)
from lifelore.interaction.selection import knowledge_gradient as gradient_module
from lifelore.interaction.selection.knowledge_gradient import knowledge_gain
from lifelore.interaction.selection.support import truncated

from ..twins import naive_rules as naive
from .small_libraries import SmallLibrary, as_lists, problem, user_problem

INF = math.inf
EVERY_RULE = [
    *(rule() for rule in RULES.values()),
    BeliefEntropy(variant="thesis"),
    ExpectedImprovement("thesis"),
    ExpectedImprovement(of="outcome"),
    KnowledgeGradient("thesis"),
    KnowledgeGradient(candidates="all", mass=1.0),
    KnowledgeGradient(candidates="responses"),
    ValueOfPerfectInformation("once"),
    ProbabilityOfImprovement(variant="thesis"),
    ProbabilityOfImprovement(target=17.0),
]
SCORING_RULES = [rule for rule in EVERY_RULE if rule.name not in ("epsilon-greedy", "sampling")]


def exact(numbers, scale=1.0):
    """Equal to 1e-12, relative to the number or to the `scale` of the sums that it comes from."""
    return pytest.approx(np.asarray(numbers), rel=1e-12, abs=1e-12 * scale)


# ---- twins ---------------------------------------------------------------------------------------------------


def assert_like_twins(score, library, belief):
    """`score(rule)` gives the scores of plain loops for every rule, under a belief of `library`."""
    mean, deviation, laws = as_lists(library)
    b, scale = belief.tolist(), float(np.abs(mean).max())
    now = naive.utilities(b, mean)
    assert score(Greedy()) == exact(now, scale)
    assert score(ExpectedImprovement()) == exact(naive.mean_improvement(b, mean), scale)
    assert score(ExpectedImprovement(of="outcome")) == pytest.approx(
        naive.expected_improvement(b, mean, deviation), rel=1e-6, abs=1e-7
    )
    top = max(max(row) for weight, row in zip(b, mean, strict=True) if weight > 0)
    for target in (None, 17.0):
        found = score(ProbabilityOfImprovement(target))
        assert found == exact(naive.probability_above(b, mean, deviation, top if target is None else target))
    found = score(BeliefEntropy(kappa=40.0, mass=1.0)) - 40 * naive.entropy(b)
    assert found == exact(naive.belief_entropy(b, mean, laws, 40.0), scale)
    gained = np.array(naive.knowledge_gain(b, mean, laws))
    for candidates in ("auto", "all"):
        found = score(KnowledgeGradient(mass=1.0, candidates=candidates))
        assert found == exact(now + 7 * gained, 7 * scale)
    perfect = np.array(naive.perfect_gain(b, mean))
    for counted, weight in (("episodes", 7), ("once", 1)):
        assert score(ValueOfPerfectInformation(counted)) == exact(now + weight * perfect, 7 * scale)
    # A ratio to a small difference of entropies has the rounding of that difference.
    ratio = naive.information_ratio(b, mean, laws)
    assert score(InformationDirected(mass=1.0)) ** 2 == pytest.approx(ratio, rel=1e-5)


def assert_like_printed_twins(score, library, belief):
    """`score(rule)` gives the scores of plain loops for every printed form, under a belief of `library`."""
    mean, deviation, laws = as_lists(library)
    b, scale = belief.tolist(), float(np.abs(mean).max())
    now = naive.utilities(b, mean)
    assert score(ExpectedImprovement("thesis")) == exact(naive.probability_above(b, mean, deviation, max(now)))
    found = score(ProbabilityOfImprovement(variant="thesis", margin=3.0))
    assert found == exact(naive.density_at(b, mean, deviation, max(now) + 3.0))
    printed = [naive.entropy(naive.printed_posterior(b, law)) for law in laws]
    assert score(BeliefEntropy(20.0, "thesis")) == exact(np.array(now) - 20 * np.array(printed), scale)
    gained = np.array(naive.printed_gain(b, mean, laws))
    assert score(KnowledgeGradient("thesis")) == exact(now + 7 * gained, 7 * scale)


TWINS = [assert_like_twins, assert_like_printed_twins]


@pytest.mark.parametrize("assert_like", TWINS)
@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 2**32 - 1))
def test_rules_agree_with_plain_twins(assert_like, seed):
    library, belief = problem(seed)
    assert_like(lambda rule: rule.scores(library, belief, episodes_left=7), library, belief)


# ---- many users ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rule", SCORING_RULES, ids=repr)
@settings(deadline=None, max_examples=10)
@given(seed=st.integers(0, 2**32 - 1), n_types=st.integers(1, 9), n_policies=st.integers(1, 7))
def test_rows_are_scored_as_one_by_one(rule, seed, n_types, n_policies):
    users, beliefs = user_problem(seed, 4, n_types + 1, n_policies)
    shared = users.row(0)
    for library, alone in ((shared, [shared] * 4), (users, [users.row(row) for row in range(4)])):
        found = rule.scores(library, beliefs, episodes_left=4)
        one_by_one = [rule.scores(own, b, episodes_left=4) for own, b in zip(alone, beliefs, strict=True)]
        # Ratios to informations near 0 have the rounding of a difference of entropies.
        close = 1e-6 if rule.name == "information-directed" else 1e-12
        assert found == pytest.approx(np.array(one_by_one), rel=close, abs=1e-10)


# ---- by hand -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("noise", [1.0, 1e3])
def test_without_an_improvement_of_the_pay_selection_is_greedy(noise):
    mean = np.array([[3.0, 7.0, 7.0, 1.0], [7.0, 7.0, 2.0, 0.0], [90.0, 5.0, 0.0, 90.0]])
    library = SmallLibrary(mean, noise * np.arange(1, 13.0).reshape(3, 4))
    rule = ExpectedImprovement()
    # A certain type; two types with one best policy; a better type that is all but ruled out.
    none = np.array([[1.0, 0, 0], [0, 1.0, 0], [0.4, 0.6, 0], [1 - 1e-12, 0, 1e-12]])
    some = np.array([0.5, 0.0, 0.5])
    rows = np.stack([none[0], some, none[1], some, none[2], none[3]])
    shares = propensities(rule, library, rows)
    assert np.array_equal(shares[[0, 2, 4, 5]], propensities(Greedy(), library, none))
    assert shares[0].tolist() == [0, 0.5, 0.5, 0]
    assert shares[4].tolist() == [0, 1, 0, 0]
    for row, share in zip(rows, shares, strict=True):
        assert np.array_equal(propensities(rule, library, row), share)
    # Where a pay can improve, the score is the improvement: here policies 0 and 3 on type 2 alone.
    best = 0.5 * 3 + 0.5 * 90
    assert rule.scores(library, some).tolist() == [0.5 * (90 - best), 0, 0, 0.5 * (90 - best)]


def test_small_libraries_consider_all_policies_and_large_ones_the_best_responses(monkeypatch):
    # Types, policies, signals: 7 · 9² · 6 products.
    wrong = 0
    for seed in range(15):
        users, beliefs = user_problem(seed, 2, 7, 9, 6)
        library, belief = users.row(0), beliefs[0]
        mean, table = library.performance.mean, library.table()
        lists, b = as_lists(library), belief.tolist()
        best = np.array(naive.knowledge_gain(b, lists[0], lists[2]))
        own = np.unique([*mean[belief > 0].argmax(axis=1), (belief @ mean).argmax()]).tolist()
        shortcut = naive.knowledge_gain(b, lists[0], lists[2], own)
        monkeypatch.setattr(gradient_module, "LARGEST_EXACT", 7 * 9**2 * 6)
        assert knowledge_gain(belief, mean, table, 1.0, "auto") == exact(best, 200)
        monkeypatch.setattr(gradient_module, "LARGEST_EXACT", 7 * 9**2 * 6 - 1)
        assert knowledge_gain(belief, mean, table, 1.0, "auto") == exact(shortcut, 200)
        rows = knowledge_gain(beliefs, users.performance.mean, users.table(), 1.0, "auto")
        assert rows[0] == exact(shortcut, 200)
        wrong += bool((np.abs(best - shortcut) > 1e-6).any())
    # The shortcut leaves out policies that are second best on many types: in most of these libraries some score.
    assert wrong > 2


# ---- the mass of a belief ------------------------------------------------------------------------------------


def test_support_holds_its_mass_and_no_fixed_number():
    belief = np.array([0.6, 0.3, 0.0, 0.09, 0.01])
    assert truncated(belief, 0.95) == pytest.approx(np.array([0.6, 0.3, 0, 0.09, 0]) / 0.99)
    assert np.flatnonzero(truncated(belief, 1.0)).tolist() == [0, 1, 3, 4]
    # A flat belief keeps everything: types exactly as likely as the last one taken are taken too.
    assert np.count_nonzero(truncated(np.full(5000, 1 / 5000), 0.5)) == 5000
    assert truncated(np.array([0.0, 1.0]), 0.999).tolist() == [0, 1]


# ---- odd tables, means and beliefs ---------------------------------------------------------------------------


WITHOUT = """
import sys
import numpy as np
from lifelore.interaction.finite_signals.signal_bins import normal_table
from lifelore.interaction.selection import choose
from lifelore.interaction.selection.information import mutual_information
from lifelore.interaction.selection.knowledge_gradient import knowledge_gain
mean, belief, deviation = np.arange(9.0).reshape(3, 3) % 5, np.full(3, 1 / 3), np.ones((3, 3))
_, table = normal_table(mean, deviation, 8)
for scores in (mutual_information(belief, table), knowledge_gain(belief, mean, table)):
    choose(scores, np.random.default_rng(0))
print([name for name in ("numba", "scipy") if name in sys.modules])
"""


@pytest.mark.slow
def test_a_choice_in_a_small_library_needs_neither_compiler_nor_scipy():
    done = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


# ---- rules by name or object, and bad settings ---------------------------------------------------------------


def test_a_rule_is_given_by_name_as_an_object_or_not_at_all():
    library = SmallLibrary([[1.0, 0.0]])
    mine = KnowledgeGradient(lookahead=3.0)
    assert rule_of(mine, library) is mine
    assert rule_of("greedy", library) == Greedy()
    assert rule_of(None, library) == rule_named(DEFAULT_RULE)
    assert rule_of(None, SmallLibrary([[1.0]], has_table=False)) == rule_named(WITHOUT_TABLE)
    with pytest.raises(NotFoundError, match=r"rule must be one of greedy.*got 'best'"):
        rule_of("best", library)
    for wrong in (7, Greedy, ["greedy"], {"scores": 1}):
        with pytest.raises(InputError, match="rule must be a selection rule or its name, one of greedy"):
            rule_of(wrong, library)


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


@pytest.mark.parametrize("rule", [KnowledgeGradient(), ValueOfPerfectInformation()])
def test_a_negative_number_of_episodes_left_is_refused(rule):
    library, belief = problem(0)
    with pytest.raises(InputError, match="episodes_left must be at least 0, got -5"):
        rule.scores(library, belief, episodes_left=-5)


def test_unknown_rules_and_missing_generators_are_named():
    with pytest.raises(NotFoundError, match="rule must be one of greedy"):
        rule_named("best")
    library, belief = problem(0)
    for rule in (BeliefSampling(), EpsilonGreedy()):
        with pytest.raises(InputError, match="give a generator"):
            rule.scores(library, belief)


def test_rules_that_look_ahead_need_signals_that_can_be_listed():
    library = SmallLibrary(np.eye(2), has_table=False)
    for rule in (BeliefEntropy(), KnowledgeGradient(), InformationDirected()):
        with pytest.raises(InputError, match="no finite alphabet"):
            rule.scores(library, library.prior)


def test_every_rule_is_registered_under_its_name():
    assert all(rule.name == name for name, rule in RULES.items())
    assert len(RULES) == 9
