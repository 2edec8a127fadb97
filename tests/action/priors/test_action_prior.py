"""Action priors: closed forms, a dictionary twin, merging, forms, masks, entropy, and records."""

import math
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.action.priors.action_prior import FORMS, MOST_WEIGHT, ONE, ActionPrior
from lifelore.core.errors import InputError, MissingExtraError, NotFoundError
from lifelore.core.protocols import Record
from lifelore.core.streams import stream

N_ACTIONS = 3
codes = st.integers(-(2**60), 2**60)
weights = st.sampled_from([0.0, 0.1, 1.0, 2.5, 1 / 3, 1000.0])
rows = st.lists(st.tuples(st.one_of(st.integers(-3, 3), codes), st.lists(st.booleans(), min_size=3, max_size=3)))
updates = st.lists(st.tuples(rows, weights), max_size=6)


def prior_of(steps, alpha0=0.1) -> ActionPrior:
    prior = ActionPrior(N_ACTIONS, alpha0, "key")
    for counted, weight in steps:
        contexts = np.array([code for code, _ in counted], np.int64)
        prior.update(contexts, np.array([best for _, best in counted], bool).reshape(-1, N_ACTIONS), weight)
    return prior


def counted(*counts, alpha0=0.1) -> ActionPrior:
    """A prior whose context 0 has these counts, context 1 these the other way round."""
    prior = ActionPrior(len(counts), alpha0)
    for context, row in enumerate([counts, counts[::-1]]):
        for action, count in enumerate(row):
            prior.update_trajectory([context], [action], count)
    return prior


def same_bits(one: ActionPrior, other: ActionPrior) -> bool:
    return np.array_equal(one._codes, other._codes) and np.array_equal(one._counts, other._counts)


# ---- closed forms ------------------------------------------------------------------------------------


def test_counts_by_hand():
    # Eq. 3.5: context 7 is best-served by action 0 once and by both once: (2 + ½) / (2 + 1 + 2·½).
    prior = ActionPrior(2, alpha0=0.5)
    prior.update([7, 7, 9], [[True, False], [True, True], [False, False]])
    assert prior.counts([7, 9]).tolist() == [[2.0, 1.0], [0.0, 0.0]]
    assert prior.probs([7, 9]).tolist() == [[0.625, 0.375], [0.5, 0.5]]
    assert prior.contexts.tolist() == [7]  # a row without a best action counts nothing
    assert len(prior) == 1


def test_two_policies_with_weights_by_hand():
    # Eq. 3.4, 3.5: α(a) = Σ w U + α⁰ = (1 + 0.1, 3 + 0.1, 1 + 3 + 0.1); θ is its proportion (Eq. 3.6).
    prior = ActionPrior(3, alpha0=0.1)
    prior.update([4], [[True, False, True]], weight=1.0)
    prior.update([4], [[False, True, True]], weight=3.0)
    assert prior.probs([4])[0] == pytest.approx(np.array([1.1, 3.1, 4.1]) / 8.3)


def test_a_weight_for_each_action():
    prior = ActionPrior(3)
    prior.update([4, 5, 4], [[True, True, False]] * 3, weight=[[1.0, 0.5, 9.0], [0.0, 0.0, 1.0], [0.25, 0.0, 0.0]])
    assert prior.counts([4]).tolist() == [[1.25, 0.5, 0.0]]  # what is not best counts nothing
    assert prior.contexts.tolist() == [4]
    prior.update([], np.empty((0, 3)), weight=[])
    assert len(prior) == 1


def test_a_weight_for_each_row():
    prior, by_hand = ActionPrior(2), ActionPrior(2)
    prior.update([4, 4, 9, 9], [[True, False], [False, True], [True, True], [False, True]], [0.25, 0.75, 0.0, 0.0])
    by_hand.update([4], [[True, False]], 0.25)
    by_hand.update([4], [[False, True]], 0.75)
    assert np.array_equal(prior.counts([4]), by_hand.counts([4]))
    assert prior.contexts.tolist() == [4]  # a row of weight 0 counts nothing


def test_states_of_one_percept_pool():
    # Eq. 3.7, 3.8: three states look alike; the counts of all three meet in their percept.
    prior = ActionPrior(2, alpha0=1.0)
    prior.update([5, 5, 5], [[True, False], [True, False], [False, True]])
    assert prior.probs([5])[0] == pytest.approx([3 / 5, 2 / 5])


def test_demonstrations_count_visits():
    prior = ActionPrior(2, alpha0=0.1)
    prior.update_trajectory([1, 1, 2], [0, 0, 1], weight=2.0)
    assert prior.counts([1, 2]).tolist() == [[4.0, 0.0], [0.0, 2.0]]
    prior.update_trajectory([], [])
    assert len(prior) == 2


def test_forms_by_hand():
    prior = counted(3, 1, 0, alpha0=1.0)
    at = {form: prior.probs([0], form, generator=stream(0)) for form in FORMS}
    assert at["proportion"][0] == pytest.approx([4 / 7, 2 / 7, 1 / 7])
    e = np.exp([3, 1, 0])
    assert at["softmax"][0] == pytest.approx(e / e.sum())
    assert at["support"][0] == pytest.approx([0.98 / 2 + 0.02 / 3, 0.98 / 2 + 0.02 / 3, 0.02 / 3])
    root = np.sqrt([4, 2, 1])
    assert prior.probs([0], "tempered", beta=0.5)[0] == pytest.approx(root / root.sum())


def test_nothing_counted_is_uniform_in_every_form():
    prior = counted(3, 1, 0)
    for form in FORMS:
        if form != "dirichlet":
            assert prior.probs([99], form)[0] == pytest.approx([1 / 3] * 3)
            assert ActionPrior(3).probs([99], form)[0] == pytest.approx([1 / 3] * 3)


# ---- a twin of dictionaries ----------------------------------------------------------------------------


@pytest.mark.slow
@given(updates, st.lists(codes, max_size=5))
def test_batched_reading_is_a_dictionary_of_lists(steps, asked):
    twin: dict[int, list[float]] = {}
    for counted_rows, weight in steps:
        for code, best in counted_rows:
            if any(best) and round(weight * ONE):
                row = twin.setdefault(code, [0, 0, 0])
                for action in range(N_ACTIONS):
                    row[action] += best[action] * round(weight * ONE)
    prior = prior_of(steps)
    asked = [*asked, *twin]
    expected = [[count / ONE for count in twin.get(code, [0, 0, 0])] for code in asked]
    assert prior.counts(asked).tolist() == expected
    assert prior.contexts.tolist() == sorted(twin)
    assert prior.unseen(asked).tolist() == [code not in twin for code in asked]
    mass = np.array(expected).reshape(-1, 3) + 0.1
    assert prior.probs(asked) == pytest.approx(mass / mass.sum(axis=1, keepdims=True))


# ---- merging -------------------------------------------------------------------------------------------


@pytest.mark.slow
@given(st.lists(updates, min_size=1, max_size=5), st.randoms(use_true_random=False))
def test_any_order_and_grouping_give_the_same_bits(parts, random):
    priors = [prior_of(steps) for steps in parts]
    whole = ActionPrior.merged(priors)
    random.shuffle(priors)
    while len(priors) > 1:  # join any two until one is left
        random.shuffle(priors)
        priors.append(ActionPrior.merged([priors.pop(), priors.pop()]))
    assert same_bits(priors[0], whole)
    assert same_bits(whole, prior_of([step for steps in parts for step in steps]))


def test_weights_add_without_rounding():
    tenth, many = ActionPrior(2), ActionPrior(2)
    tenth.update([0], [[True, False]], weight=0.1)
    for _ in range(1000):
        many.merge(tenth)
    # 0.1 is kept as 104,858 / 2^20; a thousand of them are exactly that, and 0.1 to six digits.
    assert many.counts([0])[0, 0] == 1000 * 104_858 / ONE
    assert tenth.counts([0])[0, 0] == pytest.approx(0.1, abs=1e-6)


def test_merging_leaves_the_sources_as_they_were():
    one, two = counted(1, 0), counted(0, 1)
    ActionPrior.merged([one, two])
    assert one.counts([0]).tolist() == [[1.0, 0.0]]
    assert two.counts([0]).tolist() == [[0.0, 1.0]]


@pytest.mark.parametrize("other", [ActionPrior(2, key="other"), ActionPrior(3, key="mine")])
def test_strangers_do_not_merge(other):
    with pytest.raises(InputError, match="priors must agree in actions and key, got 2 'mine' and"):
        ActionPrior(2, key="mine").merge(other)


# ---- records -------------------------------------------------------------------------------------------


@pytest.mark.slow
@given(updates)
def test_a_record_holds_the_prior(steps):
    prior = prior_of(steps)
    record = prior.to_record({"domain": "test"})
    assert (record.kind, record.key, record.version, record.merge) == ("action_prior", "key", 1, "add")
    assert record.slots.dtype == record.values.dtype == np.int64
    assert len(np.unique(record.slots)) == len(record.slots)
    assert (record.values > 0).all()
    back = ActionPrior.from_record(record, N_ACTIONS, alpha0=0.7)
    assert same_bits(back, prior)
    assert (back.key, back.alpha0) == ("key", 0.7)


def test_a_records_numbers_by_hand():
    prior = ActionPrior(4, alpha0=9.0)
    prior.update([-1, 2], [[False, True, False, False], [True, False, False, True]], weight=0.5)
    record = prior.to_record()
    # slot = code · 4 + action; α⁰ takes no part.
    assert record.slots.tolist() == [-3, 8, 11]
    assert record.values.tolist() == [ONE // 2] * 3


def test_the_largest_codes_survive_a_record():
    largest = (2**63 - 1) // 4
    prior = ActionPrior(3)
    prior.update([largest, -largest], [[False, False, True]] * 2)
    assert ActionPrior.from_record(prior.to_record(), 3).contexts.tolist() == [-largest, largest]
    for code in (largest + 1, -largest - 1):
        with pytest.raises(InputError, match="contexts must be codes of magnitude at most"):
            prior.update([code], [[True, False, False]])


def test_a_foreign_record_is_refused():
    for kind, version in (("transitions", 1), ("action_prior", 2)):
        record = Record(kind, "k", version, "add", np.array([1]), np.array([1]))
        with pytest.raises(InputError, match="record must be action_prior version 1"):
            ActionPrior.from_record(record, 2)


# ---- forms ---------------------------------------------------------------------------------------------


@pytest.mark.slow
@settings(max_examples=50)
@given(updates, st.sampled_from(FORMS), st.floats(0, 20), st.floats(0, 1))
def test_rows_sum_to_one_in_every_form(steps, form, beta, escape):
    prior = prior_of(steps)
    asked = np.append(prior.contexts, 12345)
    probs = prior.probs(asked, form, generator=stream(0), beta=beta, escape=escape)
    assert probs.shape == (len(asked), N_ACTIONS)
    assert probs.sum(axis=1) == pytest.approx(np.ones(len(asked)), abs=1e-12)
    assert (probs >= 0).all()


@pytest.mark.slow
@given(updates, st.floats(1e-6, 1))
def test_support_with_an_escape_excludes_nothing(steps, escape):
    prior = prior_of(steps)
    probs = prior.probs(prior.contexts, "support", escape=escape)
    assert (probs >= escape / N_ACTIONS * (1 - 1e-12)).all()
    sharp = prior.probs(prior.contexts, "support", escape=0.0)
    assert ((sharp > 0) == (prior.counts(prior.contexts) > 0)).all()


@pytest.mark.slow
@given(updates)
def test_tempered_goes_from_uniform_to_proportion(steps):
    prior = prior_of(steps)
    asked = prior.contexts
    assert prior.probs(asked, "tempered", beta=1.0) == pytest.approx(prior.probs(asked))
    assert prior.probs(asked, "tempered", beta=0.0) == pytest.approx(np.full((len(asked), 3), 1 / 3))


def test_softmax_follows_differences_of_counts_and_stays_finite():
    probs = counted(2000, 1000, 0).probs([0], "softmax")
    assert probs.tolist() == [[1.0, 0.0, 0.0]]
    scaled = counted(2000, 1000, 0).probs([0], "softmax", beta=1e-3)[0]
    assert scaled == pytest.approx(np.exp([2, 1, 0]) / np.exp([2, 1, 0]).sum())


def test_dirichlet_draws_have_the_proportion_as_their_mean():
    prior, n = counted(3, 1, 0, alpha0=0.5), 20_000
    drawn = prior.probs(np.zeros(n, int), "dirichlet", generator=stream(1))
    alpha = np.array([3.5, 1.5, 0.5])
    share = alpha / alpha.sum()
    # Variance of one share: p (1 - p) / (Σα + 1); the mean of n draws is within four deviations.
    bound = 4 * np.sqrt(share * (1 - share) / (alpha.sum() + 1) / n)
    assert (np.abs(drawn.mean(axis=0) - share) < bound).all()
    assert (np.abs(drawn.mean(axis=0) - prior.probs([0])[0]) < bound).all()
    assert len(np.unique(drawn[:, 0])) > n / 2


def test_dirichlet_of_tiny_pseudo_counts_is_no_division_of_nothing():
    drawn = ActionPrior(4, alpha0=1e-6).probs(np.arange(2000), "dirichlet", generator=stream(2))
    assert np.isfinite(drawn).all()
    assert drawn.sum(axis=1) == pytest.approx(np.ones(2000))


def test_samples_follow_the_probabilities():
    prior, n = counted(3, 1, 0, alpha0=0.5), 20_000
    drawn = np.bincount(prior.sample(np.zeros(n, int), stream(3)), minlength=3)
    # Deviation at most √(n/4) = 71; four of them.
    assert drawn == pytest.approx(n * prior.probs([0])[0], abs=284)
    sharp = prior.sample(np.zeros(n, int), stream(3), "support", escape=0.0)
    assert set(sharp.tolist()) == {0, 1}


# ---- masks, entropy, coarser contexts ------------------------------------------------------------------


def test_masks_by_hand():
    prior = counted(6, 3, 1)
    assert prior.mask([0, 99]).tolist() == [[True, True, True], [True, True, True]]
    assert prior.mask([0, 1], 0.2).tolist() == [[True, True, False], [False, True, True]]
    assert prior.mask([0], 0.3).tolist() == [[True, False, False]]  # a share of 0.3 does not exceed 0.3
    assert prior.mask([0], 0.9).tolist() == [[True, True, True]]  # none does: nothing is masked


def test_exclusion_rate_by_hand():
    prior = counted(6, 3, 1)
    best = [[False, False, True], [True, False, True], [False, False, False], [False, True, False]]
    # Context 0 loses its only best action, context 1 keeps one, the third has none, the last is unseen.
    assert prior.exclusion_rate([0, 1, 0, 99], best, 0.2) == pytest.approx(1 / 3)
    assert prior.exclusion_rate([0], [[False, False, False]]) == 0.0


def test_entropy_by_hand():
    prior = counted(1, 1, 0, alpha0=5.0)
    prior.update([7], [[False, True, False]], weight=4.0)
    assert prior.entropy([0, 7, 99]) == pytest.approx([math.log(2), 0.0, math.log(3)])


@pytest.mark.slow
@given(updates)
def test_entropy_lies_between_certain_and_uniform(steps):
    prior = prior_of(steps)
    entropy = prior.entropy(prior.contexts)
    assert (entropy >= -1e-12).all()
    assert (entropy <= math.log(N_ACTIONS) + 1e-12).all()


@pytest.mark.slow
@given(updates, st.integers(1, 5))
def test_coarser_contexts_keep_every_count(steps, modulus):
    prior = prior_of(steps)
    coarse = prior.marginalise(prior.contexts % modulus, "coarse")
    assert coarse.key == "coarse"
    for code in range(modulus):
        finer = prior.contexts[prior.contexts % modulus == code]
        # Whole counts of 2^-20 add exactly.
        assert coarse.counts([code])[0].tolist() == prior.counts(finer).sum(axis=0).tolist()


def test_coarser_contexts_need_a_code_each():
    with pytest.raises(InputError, match="one code for each of 2 contexts, got 1"):
        counted(1, 2).marginalise([0])


def test_unseen_rate():
    assert counted(1, 0).unseen([0, 1, 2, 3]).mean() == 0.5
    nothing = ActionPrior(2)
    nothing.update([3], [[True, False]], weight=0.0)
    assert nothing.unseen([3]).all()
    assert len(nothing) == 0


# ---- rules ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda p: ActionPrior(0), "n_actions must be at least 1, got 0"),
        (lambda p: ActionPrior(2, alpha0=0.0), "alpha0 must be positive and finite, got 0.0"),
        (lambda p: ActionPrior(2, alpha0=float("nan")), "got nan"),
        (lambda p: ActionPrior(2, alpha0=float("inf")), "got inf"),
        (lambda p: p.update([1], [[True, False, True]]), r"best must have shape \(1, 2\)"),
        (lambda p: p.update([1, 2], [[True, False]]), r"best must have shape \(2, 2\)"),
        (lambda p: p.update([1], [[True, False]], -1.0), "weight must lie in"),
        (
            lambda p: p.update([1], [[True, False]], [1.0, 2.0]),
            r"weight must be a number, \(1,\), one a row, or \(1, 2\)",
        ),
        (lambda p: p.update([1], [[True, False]], float("nan")), "weight must lie in"),
        (lambda p: p.update([1], [[True, False]], 2 * MOST_WEIGHT), "weight must lie in"),
        (lambda p: p.update_trajectory([1], [2]), r"actions must lie in \[0, 2\), got 2..2"),
        (lambda p: p.update_trajectory([1], [-1]), "got -1..-1"),
        (lambda p: p.update_trajectory([1, 2], [0]), "best must have shape"),
        (lambda p: p.probs([1], "dirichlet"), "pass generator="),
        (lambda p: p.probs([1], "support", escape=1.5), r"escape must lie in \[0, 1\], got 1.5"),
        (lambda p: p.probs([1], "tempered", beta=-1.0), "beta must be finite and at least 0, got -1.0"),
        (lambda p: p.probs([1], "softmax", beta=float("nan")), "got nan"),
    ],
)
def test_broken_rules(call, message):
    with pytest.raises(InputError, match=message):
        call(ActionPrior(2))


def test_an_unknown_form_names_the_known_ones():
    with pytest.raises(NotFoundError, match=f"one of {', '.join(FORMS)}, got 'mean'"):
        ActionPrior(2).probs([1], "mean")


# ---- tables ------------------------------------------------------------------------------------------


def test_columns_in_long_format_by_hand():
    prior = ActionPrior(2, alpha0=0.5)
    prior.update([9, 7, 7], [[False, True], [True, False], [True, True]])
    columns = prior.to_columns(labels={7: ("wall", 1)})
    assert {name: column.tolist() for name, column in columns.items()} == {
        "context": [7, 7, 9, 9],
        "label": ["('wall', 1)", "('wall', 1)", "9", "9"],
        "action": [0, 1, 0, 1],
        "count": [2.0, 1.0, 0.0, 1.0],
        "probability": [0.625, 0.375, 0.25, 0.75],
    }
    assert list(prior.to_columns()) == ["context", "action", "count", "probability"]
    assert all(len(column) == 0 for column in ActionPrior(2).to_columns({}).values())


def test_a_frame_is_the_columns_where_pandas_is_installed():
    pandas = pytest.importorskip("pandas")
    prior = counted(2.0, 1.0)
    assert prior.to_frame().equals(pandas.DataFrame(prior.to_columns()))


def test_a_frame_without_pandas_names_the_next_step(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(MissingExtraError, match=r"pip install pandas, or use to_columns\(\)"):
        counted(2.0, 1.0).to_frame()


def test_repr_gives_the_size_and_the_key():
    prior = prior_of([([(1, [True, False, True]), (2, [True, False, False])], 0.5)])
    assert repr(prior) == "<ActionPrior: 3 actions, 2 contexts, 1.5 counts, alpha0=0.1, key='key'>"
    assert repr(ActionPrior(2)) == "<ActionPrior: 2 actions, 0 contexts, 0 counts, alpha0=0.1>"


def test_own_labels_stand_in_tables_and_merge():
    prior, other = ActionPrior(2), ActionPrior(2)
    prior.update([7], [[True, False]])
    assert "label" not in prior.to_columns()
    other.update([7, 8], [[True, False], [False, True]])
    prior.labels, other.labels = {7: ("free", 1)}, {7: "seven", 8: ("wall", 0)}
    prior.merge(other)
    assert prior.to_columns()["label"].tolist() == ["('free', 1)"] * 2 + ["('wall', 0)"] * 2
    assert prior.to_columns({8: "eight"})["label"].tolist() == ["7", "7", "eight", "eight"]


# ---- what may be counted -----------------------------------------------------------------------------


def test_what_is_not_boolean_is_refused_and_a_policy_counts_its_largest():
    prior = ActionPrior(3)
    for wrong in ([[0.2, 0.5, 0.3]], [[0, 1, 0]], [[1.5, 2.0, -1.0]]):
        with pytest.raises(InputError, match=r"best must be boolean.*count π by ActionPrior.update_policy"):
            prior.update([4], wrong)
    # Eq. 3.5 counts w(π) for each largest probability, whatever it is; a row of zeros is no policy.
    prior.update_policy([4, 4, 5], [[0.2, 0.5, 0.3], [0.4, 0.2, 0.4], [0.0, 0.0, 0.0]], weight=2.0)
    assert prior.counts([4, 5]).tolist() == [[2.0, 2.0, 2.0], [0.0, 0.0, 0.0]]
    assert prior.contexts.tolist() == [4]
    for wrong in ([[0.2, 0.5, 0.2]], [[1.2, -0.2, 0.0]], [0.2, 0.5, 0.3]):
        with pytest.raises(InputError, match="policy must hold probabilities"):
            prior.update_policy([4], wrong)
    with pytest.raises(InputError, match=r"contexts must be whole numbers.*float64"):
        prior.update([0.5], [[True, False, False]])
    with pytest.raises(InputError, match="contexts must be whole numbers"):
        prior.probs(["door"])


def test_pseudo_counts_by_context_and_action():
    # Eq. 3.4: α_s(a) = Σ w U + α⁰_s(a), here α⁰ = (1, 2) in context 4 and (3, 1) in context 5.
    table = {4: [1.0, 2.0], 5: [3.0, 1.0]}
    prior = ActionPrior(2, alpha0=lambda contexts: [table[code] for code in contexts.tolist()])
    prior.update([4], [[True, False]], weight=3.0)
    assert prior.probs([4, 5])[0] == pytest.approx([4 / 6, 2 / 6])
    assert prior.probs([4, 5])[1] == pytest.approx([3 / 4, 1 / 4])
    many = prior.sample(np.tile([4, 5], 20_000), stream(0))
    assert many[::2].mean() == pytest.approx(1 / 3, abs=4 * np.sqrt(0.25 / 20_000))
    assert many[1::2].mean() == pytest.approx(1 / 4, abs=4 * np.sqrt(0.25 / 20_000))
    assert "alpha0=by context" in repr(prior)
    with pytest.raises(InputError, match="alpha0 must be one number here"):
        prior.marginalise([0])
    with pytest.raises(InputError, match=r"alpha0 must give positive numbers of shape \(1, 2\)"):
        ActionPrior(2, alpha0=lambda contexts: [[1.0, 0.0]]).probs([4])


def test_whole_weights_are_exact_and_others_within_the_bound():
    prior = ActionPrior(1)
    for weight in (3.0, 123_456.0):
        prior.update([0], [[True]], weight)
    assert prior.counts([0]).tolist() == [[123_459.0]]
    prior.update([1], [[True]], 1 / 3)
    assert 0 < abs(prior.counts([1])[0, 0] - 1 / 3) <= 5e-7
