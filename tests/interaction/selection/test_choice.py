"""The one chooser: equals at random, the best few, and choices among the available policies."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.selection import RULES, choose, propensities, rule_named, tied_shares
from lifelore.interaction.selection.choice import available_mask, scored

from .small_libraries import SmallLibrary, problem, user_problem

INF = math.inf
NAMES = ["a", "b", "c", "d"]
LOGS = st.one_of(st.floats(-800, 300), st.just(-INF), st.sampled_from([0.0, -0.0, -1e308, 1e308, INF]))
NEAR = st.one_of(LOGS, st.floats(1 - 3e-9, 1.0))


def available(row) -> bool:
    return bool((np.asarray(row) > -INF).any())


# ---- among equals --------------------------------------------------------------------------------------------


def plain_shares(scores, tolerance=1e-9):
    """Shares of the policies as good as the best, by plain loops."""
    best = max(scores)
    size = max(abs(s) for s in scores if s > -INF)
    tied = [s == best or (best < INF and s >= best - (tolerance * abs(best) + 1e-15 * size)) for s in scores]
    return [one / sum(tied) for one in tied]


@settings(deadline=None, max_examples=40)
@given(arrays(float, st.tuples(st.integers(1, 4), st.integers(1, 9)), elements=NEAR))
def test_shares_of_rows_agree_with_plain_loops(scores):
    if not all(available(row) for row in scores):
        with pytest.raises(InputError, match="above minus infinity"):
            tied_shares(scores)
        return
    shares = tied_shares(scores)
    assert shares == pytest.approx(np.array([plain_shares(row) for row in scores.tolist()]))
    for row, share in zip(scores, shares, strict=True):
        assert np.array_equal(tied_shares(row), share)


@settings(deadline=None, max_examples=60)
@given(arrays(float, st.tuples(st.integers(1, 5), st.integers(1, 9)), elements=NEAR), st.integers(0, 99))
def test_only_the_best_are_chosen_and_only_ties_draw(scores, seed):
    scores = scores[[available(row) for row in scores]]
    shares, random, twin = tied_shares(scores), *(np.random.default_rng(seed) for _ in range(2))
    chosen = choose(scores, random)
    assert (np.take_along_axis(shares, chosen[:, None], axis=1) > 0).all()
    twin.random(int((shares.max(axis=1) < 1).sum()))
    assert random.bit_generator.state == twin.bit_generator.state


@pytest.mark.parametrize(
    ("scores", "shares"),
    [
        ([INF, 1.0, INF], [0.5, 0, 0.5]),
        ([-INF, -5.0], [0, 1]),
        ([0.0, -1e-17, -1.0], [0.5, 0.5, 0]),
        ([-1e-12, -2e-12], [1, 0]),
        ([5.0], [1]),
        ([-INF, 2.0, -INF, 2.0, 1.0], [0, 0.5, 0, 0.5, 0]),
        ([1.0, 1.0 - 5e-10, 1.0 - 2e-9, -INF], [0.5, 0.5, 0, 0]),
    ],
)
def test_choices_at_the_ends_of_the_range(scores, shares):
    assert tied_shares(scores).tolist() == shares
    assert shares[choose(scores, np.random.default_rng(0))] > 0


@pytest.mark.parametrize(
    "scores", [[1.0, math.nan], [], [-INF, -INF], [[1.0, 2.0], [1.0, math.nan]], [[1.0], [-INF]], np.empty((2, 0))]
)
def test_nan_and_nothing_are_refused(scores):
    with pytest.raises(InputError, match="got NaN or nothing"):
        choose(scores, np.random.default_rng(0))
    with pytest.raises(InputError, match="got NaN or nothing"):
        tied_shares(scores)


# ---- which policies are available ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given_",
    [["d", "b"], ("b", "d", "b"), [3, 1], np.array([1, 3]), {"b", "d"}, ["b", 3], [False, True, False, True],
     np.array([0, 1, 0, 1], bool)],
)  # fmt: skip
def test_names_numbers_and_masks_mean_the_same(given_):
    assert available_mask(given_, NAMES).tolist() == [False, True, False, True]
    assert available_mask(given_, NAMES, n_rows=3).tolist() == [False, True, False, True]


@pytest.mark.parametrize(
    ("given_", "n_rows", "error", "words"),
    [
        ([], None, InputError, "at least one policy, got none"),
        (np.zeros(4, bool), None, InputError, "at least one policy, got none"),
        (np.eye(4, dtype=bool)[:2] & [True, False, True, True], 2, InputError, "at least one policy, got none"),
        ([True, False], None, InputError, r"\(4,\) bool"),
        (np.ones((3, 4), bool), None, InputError, r"\(4,\) bool"),
        (np.ones((3, 4), bool), 2, InputError, r"\(4,\) or \(2, 4\) bool"),
        (["b", "e"], None, NotFoundError, "unknown policy 'e'"),
        ([4], None, NotFoundError, "unknown policy 4"),
        ([-1], None, NotFoundError, "unknown policy -1"),
    ],
)
def test_bad_sets_are_refused(given_, n_rows, error, words):
    with pytest.raises(error, match=words):
        available_mask(given_, NAMES, n_rows)


# ---- scores and propensities among the available policies ----------------------------------------------------


@pytest.mark.parametrize("name", sorted(RULES))
@pytest.mark.parametrize("returns", [False, True])
def test_a_rule_scores_as_in_a_library_without_the_others(name, returns):
    library, rule = problem(0)[0], rule_named(name)
    if returns:
        # The signal is the outcome in bins, whose table depends on the outcomes.
        library = SmallLibrary(library.performance.mean, library.performance.deviation)
    beliefs = np.random.default_rng(1).dirichlet(np.ones(5), 3)
    for policies in ([0, 2], [1], [1, 2, 3]):
        part, mask = library.take(policies), np.isin(np.arange(4), policies)
        for belief in (*beliefs, beliefs):
            draws = [np.random.default_rng(3) for _ in range(2)]
            scores = scored(rule, library, belief, mask, episodes_left=9, generator=draws[0])
            alone = rule.scores(part, belief, episodes_left=9, generator=draws[1])
            if name != "epsilon-greedy":  # Its exploring scores are random numbers.
                assert scores[..., policies] == pytest.approx(alone, rel=1e-9, abs=1e-9)
            assert (scores[..., ~mask] == -INF).all()
            probs = propensities(rule, library, belief, mask, episodes_left=9)
            assert probs[..., policies] == pytest.approx(rule.probabilities(part, belief, episodes_left=9))
            assert not probs[..., ~mask].any()


@pytest.mark.parametrize("name", sorted(RULES))
@pytest.mark.parametrize("own", [False, True])
def test_users_with_masks_of_their_own_are_scored_as_alone(name, own):
    users, beliefs = user_problem(5, 9)
    rule, random = rule_named(name), np.random.default_rng(0)
    library = users if own else users.row(0)
    masks = np.array([[1, 0, 1, 0], [0, 1, 0, 0], [1, 1, 1, 1]], bool)[random.integers(3, size=9)]
    scores = scored(rule, library, beliefs, masks, episodes_left=3, generator=random)
    shares = propensities(rule, library, beliefs, masks, episodes_left=3)
    assert np.array_equal(scores == -INF, ~masks)
    assert shares.sum(axis=1) == pytest.approx(np.ones(9))
    for user, (belief, mask) in enumerate(zip(beliefs, masks, strict=True)):
        alone = users.row(user if own else 0)
        assert shares[user] == pytest.approx(propensities(rule, alone, belief, mask, episodes_left=3))
        if name not in ("epsilon-greedy", "sampling"):
            assert scores[user] == pytest.approx(scored(rule, alone, belief, mask, episodes_left=3), rel=1e-6)
