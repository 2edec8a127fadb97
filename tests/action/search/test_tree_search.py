"""Tree search against a plain twin on dictionaries, by hand, and by what a guide must do."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.action.search.tree_search import EpisodeResult, SearchSettings, play, search, search_guidance
from lifelore.core import COLLISION, TERMINAL, InputError, Tables
from lifelore.core.compiled.random_state import next_uniform, random_state

ENDS = SearchSettings(simulations=60, depth=12)


def corridor(length: int, goal: int | None = None) -> Tables:
    """Left and right along a line; its ends are walls, and moving into `goal` ends with 1."""
    goal = length - 1 if goal is None else goal
    here = np.arange(length)
    after = np.stack([np.maximum(here - 1, 0), np.minimum(here + 1, length - 1)], axis=1)
    event = np.where(after == here[:, None], COLLISION, 0)
    event = np.where((after == goal) & (here[:, None] != goal), TERMINAL, event)
    reward = np.where(event == TERMINAL, 1.0, np.where(event == COLLISION, -0.1, 0.0))
    return Tables(
        after[..., None].astype(np.int32),
        reward[..., None],
        event[..., None].astype(np.uint8),
        np.ones(1),
        np.zeros(1, np.int32),
    )


def random_world(seed: int, n_outcomes: int) -> Tables:
    random = np.random.default_rng(seed)
    shape = (7, 3, n_outcomes)
    cum = np.cumsum(random.dirichlet(np.ones(n_outcomes)))
    cum[-1] = 1.0
    return Tables(
        random.integers(0, 7, shape).astype(np.int32),
        random.integers(-2, 3, shape).astype(float),  # whole rewards make ties
        random.choice([0, 0, 0, TERMINAL, COLLISION], shape).astype(np.uint8),
        cum,
        np.arange(7, dtype=np.int32),
    )


# ---- the plain twin ------------------------------------------------------------------------------


def drawn(cum, random) -> int:
    return int(np.searchsorted(cum[:-1], next_uniform(random), side="right"))


def outcome(tables, random) -> int:
    return 0 if len(tables.outcome_cum) == 1 else drawn(tables.outcome_cum, random)


def one_of_best(values: dict, random):
    """The key of the largest value; each further equal takes the place with chance 1/k."""
    best, chosen, equals = -np.inf, None, 0
    for key, value in values.items():
        if value > best:
            best, chosen, equals = value, key, 1
        elif value == best:
            equals += 1
            if int(next_uniform(random) * equals) == 0:
                chosen = key
    return chosen


def naive_search(tables, guide, state, settings, random):
    """Nodes are the tuples of actions and outcomes that lead to them."""
    known: set[tuple] = {()}
    pulls, sums, means = {}, {}, []
    n_actions = tables.n_actions

    def promising(node, state):
        here = [(node, a) for a in range(n_actions)]
        tried = sum(pulls.get(x, 0) for x in here)
        own = sum(sums.get(x, 0.0) for x in here) / tried if tried else 0.0
        values = {}
        for a, x in enumerate(here):
            n = pulls.get(x, 0)
            q = sums[x] / n if n else own
            prior = guide.prior[guide.row[state], a]
            values[a] = settings.exploration * np.sqrt(max(1.0, tried)) * prior / (1.0 + n)
            if tried and max(means) > min(means):
                values[a] += (q - min(means)) / (max(means) - min(means))
        return one_of_best(values, random)

    for _ in range(settings.simulations):
        node, at, path, beyond = (), state, [], 0.0
        while len(path) < settings.depth:
            a = promising(node, at)
            k = outcome(tables, random)
            path.append(((node, a), tables.reward[at, a, k]))
            if tables.event[at, a, k] & TERMINAL:
                break
            at = int(tables.next_state[at, a, k])
            node = (*node, (a, k))
            if node not in known:
                known.add(node)
                worth = 1.0
                for _ in range(settings.depth - len(path)):
                    b = drawn(guide.rollout_cum[guide.row[at]], random)
                    k = outcome(tables, random)
                    beyond += worth * tables.reward[at, b, k]
                    if tables.event[at, b, k] & TERMINAL:
                        break
                    worth *= settings.discount
                    at = int(tables.next_state[at, b, k])
                break
        for x, reward in reversed(path):
            beyond = reward + settings.discount * beyond
            pulls[x] = pulls.get(x, 0) + 1
            sums[x] = sums.get(x, 0.0) + beyond
            means.append(sums[x] / pulls[x])
    root = [((), a) for a in range(n_actions)]
    if settings.by_mean:
        action = one_of_best({a: sums[x] / pulls[x] for a, x in enumerate(root) if x in pulls}, random)
    else:
        action = one_of_best({a: pulls[x] for a, x in enumerate(root) if x in pulls}, random)
    return action, [pulls.get(x, 0) for x in root], [sums.get(x, 0.0) for x in root]


@pytest.mark.slow
@given(
    st.integers(0, 10**6),
    st.integers(1, 3),
    st.integers(1, 40),
    st.integers(1, 8),
    st.sampled_from(["uniform", "prior"]),
    st.booleans(),
)
def test_the_kernel_is_the_plain_twin_to_the_bit(seed, n_outcomes, simulations, depth, rollout, by_mean):
    tables, random = random_world(seed, n_outcomes), np.random.default_rng(seed)
    guide = search_guidance(tables, random.dirichlet(np.ones(3), 4), random.integers(0, 4, 7), rollout)
    settings = SearchSettings(simulations, depth, 1.5, 0.9, by_mean)
    found = search(tables, guide, 3, settings, np.random.default_rng(seed))
    state = random_state(np.random.default_rng(seed))
    action, visits, sums = naive_search(tables, guide, 3, settings, state)
    assert found.visits.tolist() == visits
    assert found.action == action
    np.testing.assert_array_equal(found.means, [s / max(v, 1) for s, v in zip(sums, visits, strict=True)])


def test_an_episode_by_hand():
    # Two moves to the right of a corridor: 0.9 · 1, and no wall is met.
    tables = corridor(4, goal=3)
    settings = SearchSettings(200, 10, discount=0.9)
    played = play(
        tables, search_guidance(tables), 1, settings, 10, np.random.default_rng(0), np.random.default_rng(1)
    )
    assert played == EpisodeResult(2, True, 0.9, 0)
    short = play(
        tables, search_guidance(tables), 1, settings, 1, np.random.default_rng(0), np.random.default_rng(1)
    )
    assert short == EpisodeResult(1, False, 0.0, 0)


def test_each_broken_rule_is_one_clear_line():
    tables, random = corridor(4), np.random.default_rng(0)
    guide = search_guidance(tables)
    for call, words in (
        (lambda: search_guidance(tables, rollout="greedy"), "rollout must be one of uniform, prior"),
        (lambda: search_guidance(tables, [[1.0]]), "probs must have 2 columns"),
        (lambda: search_guidance(tables, [[0.5, 0.6]]), "probs must hold probabilities"),
        (lambda: search_guidance(tables, [[0.5, 0.5]] * 3), "row must give each of 4 states a row in"),
        (lambda: search_guidance(tables, [[0.5, 0.5]], [0, 0, 0, 1]), "row must give each of 4 states a row in"),
        (lambda: search(tables, guide, 4, ENDS, random), "state must lie in"),
        (lambda: search(tables, guide, 0, SearchSettings(0), random), "simulations and depth must be at least 1"),
        (lambda: search(tables, guide, 0, SearchSettings(discount=1.1), random), "discount must lie in"),
        (lambda: play(tables, guide, -1, ENDS, 5, random, random), "start must lie in"),
        (lambda: play(tables, guide, 0, ENDS, 0, random, random), "max_steps must be at least 1"),
    ):
        with pytest.raises(InputError, match=words):
            call()
