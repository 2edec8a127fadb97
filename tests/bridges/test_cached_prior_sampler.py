"""Draws from kept rows: the law of the prior in every form, what is kept and when it is forgotten."""

import numpy as np
import pytest

from lifelore.action.priors.action_prior import FORMS, ActionPrior
from lifelore.bridges.cached_prior_sampler import CachedPriorSampler
from lifelore.core.errors import InputError, NotFoundError


def counted():
    prior = ActionPrior(3, alpha0=0.5)
    prior.update([7] * 6, np.eye(3, dtype=bool)[[0, 0, 0, 0, 1, 1]])
    return prior


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("code", [7, 8])
def test_the_law_is_the_priors(form, code):
    prior, random = counted(), np.random.default_rng(1)
    draws = CachedPriorSampler(prior, form, {})
    n = 20_000
    shares = np.bincount([draws.draw(code, random) for _ in range(n)], minlength=3) / n
    # One draw of the Dirichlet for each action has, in the mean, the law of the proportion.
    expected = prior.probs([code], "proportion" if form == "dirichlet" else form)[0]
    assert np.abs(shares - expected).max() < 0.0145  # four deviations


def test_counts_are_heeded_after_forgetting():
    prior, random = ActionPrior(2), np.random.default_rng(3)
    draws = CachedPriorSampler(prior, "support", {"escape": 0.0})
    assert {draws.draw(4, random) for _ in range(100)} == {0, 1}
    prior.update([4], [[False, True]])
    assert {draws.draw(4, random) for _ in range(100)} == {0, 1}
    draws.forget()
    assert {draws.draw(4, random) for _ in range(100)} == {1}


def test_what_cannot_be_drawn_from_is_refused_at_once():
    with pytest.raises(NotFoundError, match="form must be one of"):
        CachedPriorSampler(ActionPrior(2), "greedy", {})
    with pytest.raises(InputError, match="escape must lie in"):
        CachedPriorSampler(ActionPrior(2), "support", {"escape": 2.0})
