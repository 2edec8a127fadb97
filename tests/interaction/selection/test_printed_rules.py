"""Where the thesis's selection rules are not what they are named (§4.5.2), shown on numbers.

A hilltop scans everything around it weakly, a location scans itself alone: a small surveillance world, by hand.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.interaction.selection import (
    BeliefEntropy,
    ExpectedImprovement,
    Greedy,
    KnowledgeGradient,
    ProbabilityOfImprovement,
    propensities,
)
from lifelore.interaction.selection.belief_entropy import printed_posterior
from lifelore.interaction.selection.belief_program import best_plan
from lifelore.interaction.selection.information import mutual_information
from lifelore.interaction.selection.knowledge_gradient import printed_gain

from ..twins import naive_rules as naive
from .small_libraries import SmallLibrary, as_lists


def random_library(seed: int, n_types: int = 6, n_policies: int = 5) -> tuple[SmallLibrary, np.ndarray]:
    random = np.random.default_rng(seed)
    library = SmallLibrary(random.normal(scale=60, size=(n_types, n_policies)), 20.0)
    return library, random.dirichlet(np.ones(n_types))


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_printed_knowledge_gradient_is_zero_and_selects_greedily(seed):
    library, belief = random_library(seed)
    mean, table = library.performance.mean, library.table()
    scale = np.abs(mean).max()
    assert printed_gain(belief, mean, table) == pytest.approx(np.zeros(5), abs=1e-12 * scale)
    assert naive.printed_gain(belief.tolist(), mean.tolist(), as_lists(library)[2]) == pytest.approx(
        np.zeros(5), abs=1e-12 * scale
    )
    scores = KnowledgeGradient("thesis").scores(library, belief, episodes_left=50)
    assert scores == pytest.approx(Greedy().scores(library, belief), abs=1e-10 * scale)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_printed_expected_improvement_is_probability_of_improvement_on_the_best_utility(seed):
    library, belief = random_library(seed)
    best = float((belief @ library.performance.mean).max())
    printed = ExpectedImprovement("thesis").scores(library, belief)
    assert printed == pytest.approx(ProbabilityOfImprovement(target=best).scores(library, belief), abs=1e-15)


def test_improvement_of_the_outcome_plays_the_wide_policy_for_ever():
    # One known type, so that nothing is left to learn: A pays 10 with deviation 1, B pays 6 with deviation 30.
    library, certain = SmallLibrary([[10.0, 6.0]], [[1.0, 30.0]]), np.ones(1)
    assert propensities(ExpectedImprovement(of="outcome"), library, certain).tolist() == [0.0, 1.0]
    assert propensities(ExpectedImprovement(of="pay"), library, certain).tolist() == [1.0, 0.0]
    # z = (6 − 10) / 30: 30 (z Φ(z) + φ(z)) = 10.07 for B, 1 / √(2π) for A.
    assert ExpectedImprovement(of="outcome").scores(library, certain) == pytest.approx([0.3989, 10.0745], abs=1e-4)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_printed_posterior_sums_to_more_than_one_and_the_predictive_one_is_the_belief(seed):
    library, belief = random_library(seed)
    table = library.table()
    sums = printed_posterior(belief, table).sum(axis=-1)
    # Σ F² β / Σ F β ≥ 1 by Cauchy and Schwarz, with equality only where the signal tells nothing.
    assert (sums >= 1 - 1e-12).all()
    assert (sums[mutual_information(belief, table) > 1e-3] > 1 + 1e-4).all()
    # Weighted by how likely each signal is, the expected posterior is the belief, whatever the policy.
    for law in table.probs.transpose(1, 0, 2):
        predicted = belief @ law
        expected = ((law * belief[:, None]) / np.where(predicted > 0, predicted, 1)) @ predicted
        assert expected == pytest.approx(belief, abs=1e-12)


def test_printed_probability_of_improvement_does_not_see_what_is_far_better():
    # The second policy achieves 100 on every type, the first 0: it surely exceeds 5, and its density there is nil.
    library = SmallLibrary([[0.0, 100.0], [0.0, 100.0]], 5.0)
    flat = np.array([0.5, 0.5])
    printed = ProbabilityOfImprovement(target=5.0, variant="thesis").scores(library, flat)
    assert printed[0] > 1e10 * printed[1]
    assert ProbabilityOfImprovement(target=5.0).scores(library, flat).argmax() == 1


def test_belief_entropy_needs_a_kappa_in_units_of_utility():
    library, belief = random_library(2)
    for scale in (1e-3, 1.0, 1e3):
        model = library.performance
        scaled = SmallLibrary(model.mean * scale, model.deviation * scale)
        # The default is the range of mean utilities, so that units do not matter; a fixed number would.
        assert BeliefEntropy().scores(scaled, belief) / scale == pytest.approx(
            BeliefEntropy().scores(library, belief), rel=1e-9
        )


def test_the_printed_q_has_no_horizon_and_diverges():
    # Eq. 4.3 without a horizon or discount: the value grows by the best utility with each episode, without end.
    library = SmallLibrary([[1.0, 0.5]], 0.1)
    values = [best_plan(library, k, n_bins=2).value for k in (1, 2, 4, 6)]
    assert values == pytest.approx([1.0, 2.0, 4.0, 6.0])
