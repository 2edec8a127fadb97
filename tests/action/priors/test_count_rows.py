"""Large priors: the kernels against dictionaries, and the same bits as small ones."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.action.priors import action_prior, context_index
from lifelore.action.priors.action_prior import BLOCK, ActionPrior
from lifelore.action.priors.context_index import ContextIndex
from lifelore.core.streams import stream

codes = st.one_of(st.integers(-5, 5), st.integers(-(2**61), 2**61))


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


@pytest.mark.parametrize("many", [0, action_prior.MANY])
@pytest.mark.parametrize("n_actions", [1, 7, 9])
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
