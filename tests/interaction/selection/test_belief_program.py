"""The exact program over beliefs: by hand, and as plain recursion."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.interaction.selection.belief_program import best_plan

from ..twins import naive_rules as naive
from .small_libraries import SmallLibrary, as_lists


def naive_value(belief, mean, laws, horizon):
    """Eq. 4.3 under the belief and with a horizon, by recursion over normalised posteriors."""
    if horizon == 0:
        return 0.0
    worth = []
    for policy, law in enumerate(laws):
        total = naive.utility(belief, mean, policy)
        for signal in range(len(law[0])):
            after = naive.posterior(belief, law, signal)
            if after is not None:
                total += naive.chance(belief, law, signal) * naive_value(after, mean, laws, horizon - 1)
        worth.append(total)
    return max(worth)


def small_library(seed: int) -> SmallLibrary:
    random = np.random.default_rng(seed)
    probs = random.dirichlet(np.full(3, 0.5), (3, 3))
    probs[0, 0] = [0.0, 0.3, 0.7]
    library = SmallLibrary(random.normal(scale=10, size=(3, 3)), 1.0, probs)
    library.prior = random.dirichlet(np.ones(3))
    return library


def test_looking_once_is_worth_it_by_hand():
    # Types equally likely; the third policy costs 3 and names the type; guessing earns 5 on average, knowing 10.
    probs = [[[0.5, 0.5], [0.5, 0.5], [1, 0]], [[0.5, 0.5], [0.5, 0.5], [0, 1]]]
    library = SmallLibrary([[10, 0, -3], [0, 10, -3]], 1.0, probs)
    # Guessing K times earns 5 K; looking first earns -3 + 10 (K - 1): better from K = 3.
    assert best_plan(library, 1).value == pytest.approx(5)
    assert best_plan(library, 2).value == pytest.approx(10)
    three = best_plan(library, 3)
    assert (three.value, three.first) == (pytest.approx(17), 2)
    # Guessing first and looking then leaves one episode to know: 5 - 3 + 10; less than guessing three times.
    assert three.values == pytest.approx([15, 15, 17])
    assert best_plan(library, 3, np.array([1.0, 0.0])).value == pytest.approx(30)


@settings(deadline=None, max_examples=15)
@given(st.integers(0, 2**32 - 1), st.integers(1, 3))
def test_agrees_with_plain_recursion(seed, horizon):
    library = small_library(seed)
    mean, _, laws = as_lists(library)
    plan = best_plan(library, horizon)
    assert plan.value == pytest.approx(naive_value(library.prior.tolist(), mean, laws, horizon), rel=1e-9)
    assert plan.values[plan.first] == plan.value


def test_horizons_below_one_and_trees_too_large_are_refused():
    library = small_library(0)
    with pytest.raises(InputError, match="horizon must be at least 1"):
        best_plan(library, 0)
    with pytest.raises(InputError, match="too large"):
        best_plan(library, 12)
    for belief in ([2.0, -1.0], [1.0], [np.nan, 1.0], [0.5, 0.6]):
        with pytest.raises(InputError, match="prior must be"):
            best_plan(library, 2, np.array(belief))
