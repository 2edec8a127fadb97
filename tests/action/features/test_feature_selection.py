"""Feature selection: entropies by hand, a dictionary twin, Alg. 5 and 6, and why the entropy is high."""

import math
from itertools import combinations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.action.features.counted_features import CountedFeatures, action_set_entropy
from lifelore.action.features.feature_selection import (
    OnlineFeatureSelection,
    best_feature_set,
    features_by_removal,
    independent_features,
)
from lifelore.action.features.feature_set import FeatureSet
from lifelore.action.features.uncertainty import REASONS, why_uncertain
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.streams import stream

SIZES = (2, 3, 2)
columns = st.tuples(*(st.integers(0, size - 1) for size in SIZES))
count_rows = st.lists(st.sampled_from([0, 0, 1, 2, 0.5]), min_size=3, max_size=3)
tables = st.lists(st.tuples(columns, count_rows), max_size=12)


def counted(rows, sizes=SIZES) -> CountedFeatures:
    features = FeatureSet(tuple(f"f{i}" for i in range(len(sizes))), sizes)
    cells = np.array([cell for cell, _ in rows], np.int64).reshape(-1, len(sizes))
    counts = np.array([row for _, row in rows], float).reshape(len(rows), -1) if rows else np.zeros((0, 3))
    return CountedFeatures.from_columns(cells, counts, features)


def naive_entropy(rows, kept) -> float:
    """Eq. 3.9-3.11 term by term over a dictionary."""
    alpha: dict[tuple, list[float]] = {}
    for cell, row in rows:
        own = alpha.setdefault(tuple(cell[i] for i in kept), [0.0] * len(row))
        for a, count in enumerate(row):
            own[a] += count
    total = sum(sum(own) for own in alpha.values())
    h = 0.0
    for own in alpha.values():
        for count in own:
            if count:
                theta = count / sum(own)
                h += sum(own) / total * -theta * math.log2(theta)
    return h


# ---- Eq. 3.9-3.11 ------------------------------------------------------------------------------------------


def test_entropy_of_a_prior_leaves_alpha0_out():
    features = FeatureSet(("wall", "items"), (2, 3))
    entropies = []
    for alpha0 in (0.01, 10.0):
        prior = ActionPrior(2, alpha0)
        prior.update(features.codes([[0, 0], [0, 1], [1, 2]]), [[True, False], [True, True], [False, True]])
        entropies.append(CountedFeatures.from_prior(prior, features).entropy())
    # Only the middle context is open: two of four counts.
    assert entropies == [pytest.approx(0.5)] * 2


def test_with_alpha0_counted_in_a_feature_that_tells_everything_would_seem_to_harm():
    # Printed, α and so θ and P hold α⁰ (Eq. 3.4, 3.11): of 512 configurations at most 60 are ever seen, and
    # leaving out any feature takes away many that never were, each of them uniform.
    features, random = FeatureSet(("tells", "x", "y"), (2, 16, 16)), stream(6, "alpha0")
    cells = np.column_stack([random.integers(0, size, 60) for size in features.sizes])
    case = CountedFeatures.from_columns(cells, np.eye(2)[cells[:, 0]], features)

    def printed(names) -> float:
        codes = features.coarser(case.codes, names)
        alpha = np.full((features.subset(names).n_codes, 2), 0.1)
        np.add.at(alpha, codes, case.counts)
        return action_set_entropy(alpha)

    pairs = {name: [other for other in features.names if other != name] for name in features.names}
    assert all(printed(others) < printed(features.names) for others in pairs.values())
    assert printed(features.names) > 0.5  # bits, of a choice that is never open
    assert case.entropy() == 0.0
    assert independent_features(case).names == ("tells",)


# ---- Eq. 3.12 ----------------------------------------------------------------------------------------------


@pytest.mark.slow
@settings(max_examples=25)
@given(tables, st.sampled_from([0.0, 0.05, 0.3]))
def test_the_best_set_is_the_least_of_all(rows, penalty):
    found = best_feature_set(counted(rows), penalty)
    every = {
        tuple(f"f{i}" for i in kept): naive_entropy(rows, kept)
        for n in range(4)
        for kept in combinations(range(3), n)
    }
    assert found.entropies == pytest.approx(every, abs=1e-9)
    assert found.objective == pytest.approx(min(h + penalty * len(names) for names, h in every.items()), abs=1e-9)
    equal = [names for names, h in every.items() if h + penalty * len(names) < found.objective + 1e-10]
    assert len(found.names) == min(map(len, equal))


# ---- Alg. 5 ------------------------------------------------------------------------------------------------


def test_two_copies_of_a_feature_are_both_dropped_by_alg_5_alone():
    # Alg. 5 takes features to be independent: without one copy the other still tells.
    rows = [((i, i, k), [[4.0, 0.0], [0.0, 4.0]][i]) for i, k in product(range(2), repeat=2)]
    rows[0] = ((0, 0, 0), [3.0, 1.0])  # f2 tells a little, so that the mean is above 0
    case = counted(rows, (2, 2, 2))
    assert independent_features(case).names == ("f2",)
    assert independent_features(case).increase["f0"] == pytest.approx(0.0)
    assert case.entropy(["f2"]) > 0.9
    assert len(features_by_removal(case, 0.2)) == 1
    assert features_by_removal(case, 0.2) in (("f0",), ("f1",))
    assert case.entropy(features_by_removal(case, 0.2)) < 0.5
    assert best_feature_set(case, 0.2).names == ("f0",)


# ---- Alg. 6 ------------------------------------------------------------------------------------------------


def test_online_selection_after_each_task():
    features = FeatureSet(("tells", "noise"), (2, 2))
    online = OnlineFeatureSelection(features, ("left", "right"), alpha0=0.5)
    everything = features.codes(list(product(range(2), repeat=2)))
    assert online.probs(everything).tolist() == [[0.5, 0.5]] * 4
    # Task 1 happens to tell by both features; task 2 and 3 by the first alone.
    online.update(everything, [[True, False], [True, True], [True, True], [False, True]])
    assert online.chosen.names == ("tells", "noise")
    by_the_first = [[True, False], [True, False], [False, True], [False, True]]
    choices = [online.update(everything, by_the_first) for _ in range(3)]
    assert choices[-1].names == online.chosen.names == ("tells",)
    assert len(online.choices) == 4
    # tells = 0: 8 lefts and 1 right, each with α⁰ = ½.
    assert online.prior.counts([0, 1]).tolist() == [[8.0, 1.0], [1.0, 8.0]]
    assert online.probs(everything)[:, 0] == pytest.approx([0.85, 0.85, 0.15, 0.15])
    assert online.full.counts(everything).sum() == online.prior.counts([0, 1]).sum()
    assert online.prior.key == FeatureSet(("tells",), (2,)).key(("left", "right"))


# ---- why the entropy is high -------------------------------------------------------------------------------


def test_reasons_by_hand():
    # f0 = 0: tasks disagree, whatever f1 says. f0 = 1: f1 tells. f0 = 2: nothing to tell. f0 = 3: seen once each.
    rows = [((0, 0), [8, 8]), ((0, 1), [8, 8]), ((1, 0), [16, 0]), ((1, 1), [0, 16])]
    rows += [((2, 0), [16, 0]), ((2, 1), [15, 1]), ((3, 0), [1, 0]), ((3, 1), [0, 1])]
    told = why_uncertain(counted(rows, (4, 2)), ["f0"])
    assert [REASONS[i] for i in told.reason] == [
        "tasks disagree",
        "features too poor",
        "certain",
        "too few counts",
    ]
    assert told.columns.ravel().tolist() == [0, 1, 2, 3]
    assert told.share.tolist() == pytest.approx([32 / 98, 32 / 98, 32 / 98, 2 / 98])
    assert told.entropy[[0, 1, 3]] == pytest.approx([1.0] * 3)
    assert told.with_all[[0, 1, 3]] == pytest.approx([1.0, 0.0, 0.0])
    assert told.counts_each.tolist() == [16, 16, 16, 1]
    assert told.share_of("tasks disagree") == pytest.approx(32 / 98)


@settings(max_examples=25)
@given(tables)
def test_the_two_reasons_add_up_to_the_entropy(rows):
    case = counted([(cell, row) for cell, row in rows if any(row)] or [((0, 0, 0), [1, 0, 0])])
    told = why_uncertain(case, ["f1"])
    assert told.disagreement == pytest.approx(case.entropy(), abs=1e-9)
    assert told.disagreement + told.poverty == pytest.approx(case.entropy(["f1"]), abs=1e-9)
    assert (told.with_all <= told.entropy + 1e-9).all()
    assert why_uncertain(case, case.features.names).poverty == pytest.approx(0.0, abs=1e-9)


def test_ties_of_a_single_task_leave_entropy_without_any_disagreement():
    # One task, two tied-best actions in the only state: 1 bit, and no other task to disagree with.
    prior, features = ActionPrior(2), FeatureSet(("state",), (1,))
    prior.update([0], [[True, True]], weight=8)
    told = why_uncertain(CountedFeatures.from_prior(prior, features), ["state"])
    assert (told.disagreement, told.poverty) == (1.0, 0.0)


# ---- rules -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: CountedFeatures.from_columns([[0]], [[1.0], [2.0]]), "must have a row a context"),
        (lambda: CountedFeatures.from_columns([[0]], [[-1.0]]), "counts must be finite and at least 0"),
        (lambda: best_feature_set(counted([]), -1.0), "penalty must be finite and at least 0, got -1.0"),
        (lambda: features_by_removal(counted([]), math.inf), "penalty must be finite"),
    ],
)
def test_broken_rules(call, message):
    with pytest.raises(InputError, match=message):
        call()


@settings(max_examples=25, deadline=None)
@given(tables)
def test_the_entropies_of_the_actions_sum_to_that_of_the_action_set(rows):
    found = counted(rows)
    assert found.action_entropies().sum() == pytest.approx(found.entropy(), abs=1e-12)
