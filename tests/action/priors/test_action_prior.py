"""Action priors: closed forms, a dictionary twin, merging, forms, masks, entropy, and records."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.action.priors.action_prior import FORMS, MOST_WEIGHT, ONE, ActionPrior
from lifelore.core import InputError, Record, stream

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


def test_a_weight_for_each_action():
    prior = ActionPrior(3)
    prior.update([4, 5, 4], [[True, True, False]] * 3, weight=[[1.0, 0.5, 9.0], [0.0, 0.0, 1.0], [0.25, 0.0, 0.0]])
    assert prior.counts([4]).tolist() == [[1.25, 0.5, 0.0]]  # what is not best counts nothing
    assert prior.contexts.tolist() == [4]
    prior.update([], np.empty((0, 3)), weight=[])
    assert len(prior) == 1


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


# ---- a twin of dictionaries ----------------------------------------------------------------------------


@pytest.mark.slow
@settings(max_examples=25)
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
@settings(max_examples=25)
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


# ---- records -------------------------------------------------------------------------------------------


@pytest.mark.slow
@settings(max_examples=25)
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


def test_a_foreign_record_is_refused():
    for kind, version in (("transitions", 1), ("action_prior", 2)):
        record = Record(kind, "k", version, "add", np.array([1]), np.array([1]))
        with pytest.raises(InputError, match="record must be action_prior version 1"):
            ActionPrior.from_record(record, 2)


# ---- forms ---------------------------------------------------------------------------------------------


@pytest.mark.slow
@settings(max_examples=25)
@given(updates, st.sampled_from(FORMS), st.floats(0, 20), st.floats(0, 1))
def test_rows_sum_to_one_in_every_form(steps, form, beta, escape):
    prior = prior_of(steps)
    asked = np.append(prior.contexts, 12345)
    probs = prior.probs(asked, form, generator=stream(0), beta=beta, escape=escape)
    assert probs.shape == (len(asked), N_ACTIONS)
    assert probs.sum(axis=1) == pytest.approx(np.ones(len(asked)), abs=1e-12)
    assert (probs >= 0).all()


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
@settings(max_examples=25)
@given(updates, st.integers(1, 5))
def test_coarser_contexts_keep_every_count(steps, modulus):
    prior = prior_of(steps)
    coarse = prior.marginalise(prior.contexts % modulus, "coarse")
    assert coarse.key == "coarse"
    for code in range(modulus):
        finer = prior.contexts[prior.contexts % modulus == code]
        # Whole counts of 2^-20 add exactly.
        assert coarse.counts([code])[0].tolist() == prior.counts(finer).sum(axis=0).tolist()


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
