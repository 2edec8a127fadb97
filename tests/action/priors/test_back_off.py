"""Back-off: the formula by hand, its limits, and its rules."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.back_off import posterior_mean
from lifelore.core.errors import InputError

FINE, OTHER, COARSE = 0b01_11, 0b10_11, 0b00_11
"""Two contexts that share their lower bits, and those."""


def counted(counts_by_context, alpha0=0.1) -> ActionPrior:
    prior = ActionPrior(2, alpha0)
    for context, row in counts_by_context.items():
        for action, count in enumerate(row):
            prior.update_trajectory([context], [action], count)
    return prior


def test_three_levels_by_hand():
    prior = counted({0b111: (3, 0), 0b011: (0, 2), 0b001: (4, 0)}, alpha0=1.0)
    level0 = (np.array([7, 2]) + 2 * 0.5) / (9 + 2)  # all share bit 0; drawn to uniform by α⁰·2
    level1 = (np.array([3, 2]) + 3 * level0) / (5 + 3)  # 111 and 011 share bits 0 and 1
    level2 = (np.array([3, 0]) + 3 * level1) / (3 + 3)
    assert posterior_mean(prior, [0b111], [0b011, 0b001], strength=3.0)[0] == pytest.approx(level2)


counts = st.tuples(st.integers(0, 50), st.integers(0, 50))


@pytest.mark.slow
@settings(max_examples=25)
@given(st.dictionaries(st.integers(0, 15), counts, max_size=8), st.floats(0.01, 2))
def test_without_coarser_levels_it_is_the_proportion(counts_by_context, alpha0):
    prior = counted(counts_by_context, alpha0)
    asked = np.arange(16)
    assert posterior_mean(prior, asked) == pytest.approx(prior.probs(asked))


def test_limits():
    many = counted({FINE: (75_000, 25_000), OTHER: (0, 100_000)})
    # 4 counts' worth of a share that differs by at most 1: off by at most 4 / 100,004.
    assert posterior_mean(many, [FINE], [COARSE])[0] == pytest.approx([0.75, 0.25], abs=4.1e-5)
    none_here = counted({OTHER: (3, 1)})
    coarser = none_here.marginalise(none_here.contexts & COARSE).probs([COARSE])[0]
    assert posterior_mean(none_here, [FINE], [COARSE])[0] == pytest.approx(coarser)
    assert posterior_mean(ActionPrior(2), [FINE], [COARSE]).tolist() == [[0.5, 0.5]]
    stubborn = posterior_mean(many, [FINE], [COARSE], strength=1e12)[0]
    assert stubborn == pytest.approx([75_000 / 200_000, 125_000 / 200_000], abs=1e-6)


@pytest.mark.parametrize("strength", [0.0, -1.0, float("nan"), float("inf")])
def test_strength_must_be_positive(strength):
    with pytest.raises(InputError, match=f"strength must be positive and finite, got {strength}"):
        posterior_mean(ActionPrior(2), [1], [1], strength)
