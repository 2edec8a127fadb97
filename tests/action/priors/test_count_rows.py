"""Large priors: the kernels against dictionaries, and the same bits as small ones."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.action.priors import action_prior, context_index
from lifelore.action.priors.action_prior import BLOCK, ActionPrior
from lifelore.action.priors.context_index import ContextIndex, _fill, _look_up
from lifelore.action.priors.count_rows import _in_order, _merge, draw_by_proportion, merged_rows, sorted_order
from lifelore.core.streams import stream

codes = st.one_of(st.integers(-5, 5), st.integers(-(2**61), 2**61))
more = st.lists(st.tuples(codes, st.lists(st.integers(0, 9), min_size=3, max_size=3)), min_size=1, max_size=12)


@pytest.mark.slow
@given(st.dictionaries(codes, st.lists(st.integers(0, 9), min_size=3, max_size=3), max_size=8), more)
def test_merged_rows_are_a_dictionary(known, added):
    twin = {code: list(row) for code, row in known.items()}
    for code, row in added:
        own = twin.setdefault(code, [0, 0, 0])
        for action in range(3):
            own[action] += 5 * row[action]
    before = sorted(known)
    counts = np.array([known[code] for code in before], np.int64).reshape(-1, 3)
    new = np.array([code for code, _ in added], np.int64)
    found, total = merged_rows(np.array(before, np.int64), counts, new, np.array([row for _, row in added]), 5)
    assert found.tolist() == sorted(twin)
    assert total.tolist() == [twin[code] for code in sorted(twin)]


@pytest.mark.slow
@given(st.lists(codes, min_size=1, max_size=30))
def test_sorting_by_digits_is_a_stable_sort(wanted):
    wanted = np.array(wanted, np.int64)
    order, rising = sorted_order(wanted)
    assert order.tolist() == np.argsort(wanted, kind="stable").tolist()
    assert rising.tolist() == sorted(wanted.tolist())


@pytest.mark.parametrize("crowded", [False, True])
def test_compiled_and_plain_kernels_agree(crowded):
    random = stream(5, "twins")
    codes = np.unique(random.integers(-(2**61), 2**61, 40) if not crowded else random.integers(-20, 20, 60))
    more, rows = random.choice(codes, 50) + random.integers(0, 2, 50), random.integers(0, 9, (50, 3))
    counts, uniform = random.integers(0, 2**40, (len(codes), 3)), random.random(50)
    shift = 57 if not crowded else 0
    starts = [np.zeros((int(codes[-1] - codes[0]) >> shift) + 2, np.int32) for _ in range(2)]
    answers = []
    for start, plain in zip(starts, (False, True), strict=True):

        def run(kernel, *told, plain=plain):
            return (getattr(kernel, "py_func", kernel) if plain else kernel)(*told)

        order, sorted_more = run(sorted_order, more)
        run(_fill, codes, shift, start)
        place = run(_look_up, codes, start, shift, more)
        drawn = run(draw_by_proportion, counts, place, 2.0**-20, 0.1, uniform)
        sorted_rows = run(_in_order, rows, order)
        answers.append((order, start, place, drawn, *run(_merge, codes, counts, sorted_more, sorted_rows, 7)))
    assert all(np.array_equal(one, other) for one, other in zip(*answers, strict=True))
    assert (answers[0][2] >= 0).any()
    assert (answers[0][2] < 0).any()


@pytest.mark.slow
@pytest.mark.parametrize("few", [0, context_index.FEW])
@given(known=st.sets(codes, max_size=30), asked=st.lists(codes, max_size=30))
def test_places_are_those_of_a_dictionary(few, known, asked):
    before, context_index.FEW = context_index.FEW, few
    try:
        index = ContextIndex(np.array(sorted(known), np.int64))
        asked = [*asked, *known]
        twin = {code: place for place, code in enumerate(sorted(known))}
        assert index.places(np.array(asked, np.int64)).tolist() == [twin.get(code, -1) for code in asked]
    finally:
        context_index.FEW = before


@pytest.mark.parametrize("crowded", [False, True])
def test_many_lookups_are_a_bisection(crowded):
    random = stream(0, "places")
    known = random.integers(-(2**62), 2**62, 20_000)
    if crowded:  # one far away puts all others into one bucket
        known = np.append(random.integers(0, 2**20, 20_000), 2**62)
    known = np.unique(known)
    asked = random.permutation(np.concatenate([known, random.integers(-(2**62), 2**62, 20_000), known + 1]))
    place = np.minimum(np.searchsorted(known, asked), len(known) - 1)
    expected = np.where(known[place] == asked, place, -1)
    assert np.array_equal(ContextIndex(known).places(asked), expected)


@pytest.mark.parametrize("span", [10_000, 30_000, 2**50])
def test_a_large_update_is_many_small_ones(span):
    random = stream(1, "update", span)
    contexts = random.integers(-span, span, 3 * context_index.FEW)
    best = random.random((len(contexts), 4)) < 0.3
    large, small = ActionPrior(4), ActionPrior(4)
    for part in np.array_split(np.arange(len(contexts)), 2):
        large.update(contexts[part], best[part], 0.3)
    for part in np.array_split(np.arange(len(contexts)), 12):
        small.update(contexts[part], best[part], 0.3)
    for one, other in zip(large.fixed_point_counts(), small.fixed_point_counts(), strict=True):
        assert np.array_equal(one, other)
    assert np.array_equal(large.contexts, np.unique(contexts[best.any(axis=1)]))


def test_what_was_counted_stays_when_the_arrays_change():
    contexts, best = np.arange(2 * context_index.FEW), np.ones((2 * context_index.FEW, 2), bool)
    prior = ActionPrior(2)
    prior.update(contexts, best)
    contexts += 5
    best[:] = False
    assert prior.contexts[0] == 0
    assert prior.counts([0]).tolist() == [[1.0, 1.0]]
    prior.merge(prior)
    assert prior.counts([0, len(contexts) - 1]).tolist() == [[2.0, 2.0]] * 2


@pytest.mark.parametrize("many", [0, action_prior.MANY])
@pytest.mark.parametrize("n_actions", [1, 2, 4, 6, 7, 9])
@pytest.mark.parametrize("form", ["proportion", "softmax", "support"])
def test_a_large_sample_has_the_bits_of_the_probabilities(n_actions, form, many, monkeypatch):
    monkeypatch.setattr(action_prior, "MANY", many)
    random = stream(2, "sample", n_actions)
    prior = ActionPrior(n_actions, alpha0=0.1)
    known = np.arange(0, 4 * BLOCK, 2)
    prior.update(known, random.random((len(known), n_actions)) < 0.5, 1 / 3)
    asked = random.integers(0, 4 * BLOCK, 3 * BLOCK)
    drawn = prior.sample(asked, stream(3), form)
    cum = np.cumsum(prior.probs(asked, form), axis=1)
    uniform = stream(3).random(len(asked))[:, None] * cum[:, -1:]
    assert np.array_equal(drawn, (uniform >= cum[:, :-1]).sum(axis=1))


def test_a_dirichlet_sample_draws_as_before():
    prior = ActionPrior(3)
    prior.update([1], [[True, False, True]])
    generator = stream(4)
    cum = np.cumsum(prior.probs([1, 2, 1], "dirichlet", generator=generator), axis=1)
    uniform = generator.random(3)[:, None] * cum[:, -1:]
    assert (
        prior.sample([1, 2, 1], stream(4), "dirichlet").tolist() == (uniform >= cum[:, :-1]).sum(axis=1).tolist()
    )


def test_no_contexts_no_actions():
    assert ActionPrior(3).sample([], stream(0)).tolist() == []
    assert action_prior.ActionPrior(3).probs([]).shape == (0, 3)
