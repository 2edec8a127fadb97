"""Monte-Carlo tree search on tables, guided by an action prior (PUCT).

At a node visited N times the search takes the action that maximises

    q(a) + c P(s, a) √max(1, N) / (1 + n(a))

q(a) is the mean discounted return after the action, scaled to [0, 1] by the least and largest mean of this search,
so that c has no unit. An action not yet tried has the mean of its node. P is the prior of the state's context,
n(a) the number of times the action was tried. Each simulation adds one node and ends with a rollout, drawn
uniformly or from the prior. Ties are broken at random.

The prior is the thesis's action prior: how often an action was useful in a context, over earlier tasks. Only the
simulations depend on the present task. Thesis: §3.8, §5.2.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.compiled.random_state import next_uniform, random_state, uniform_integer
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learning import cumulative
from lifelore.core.mdp import COLLISION, TERMINAL, Tables

ROLLOUTS = ("uniform", "prior")


class SearchGuidance(NamedTuple):
    """Probabilities by which a prior guides the search.

    prior : (n_rows, n_actions) float64, P(s, a) by context; rows sum to 1
    rollout_cum : (n_rows, n_actions) float64, cumulative probabilities of a rollout's actions
    row : (n_states,) int32, row of each state in the two arrays above
    """

    prior: NDArray[np.float64]
    rollout_cum: NDArray[np.float64]
    row: NDArray[np.int32]


class SearchSettings(NamedTuple):
    """Size of the search, and the rule of the move.

    simulations : int, for each move, at least 1
    depth : int, maximum number of moves in a simulation, at least 1
    exploration : float, c, at least 0
    discount : float, γ in [0, 1]
    by_mean : bool, make the move with the best mean instead of the move tried most
    """

    simulations: int = 200
    depth: int = 50
    exploration: float = 1.25
    discount: float = 0.95
    by_mean: bool = False


class SearchResult(NamedTuple):
    """Result of a search at its root.

    action : int, the action tried most (or with the best mean); ties are broken at random
    visits : (n_actions,) int64, number of times each action was tried; the sum is the number of simulations
    means : (n_actions,) float64, mean discounted return of each action; 0 if it was never tried
    """

    action: int
    visits: NDArray[np.int64]
    means: NDArray[np.float64]


class EpisodeResult(NamedTuple):
    """An episode of a searching agent: moves made, whether a terminal move ended it, return, collisions."""

    steps: int
    reached: bool
    discounted_return: float
    collisions: int


class _Tree(NamedTuple):
    """Nodes by number; the root is 0. `child` is 0 where there is no child, because the root is never a child."""

    state: NDArray[np.int32]
    child: NDArray[np.int32]
    visits: NDArray[np.int64]
    total: NDArray[np.float64]


def search_guidance(
    tables: Tables, probs: ArrayLike | None = None, row: ArrayLike | None = None, rollout: str = "prior"
) -> SearchGuidance:
    """Make the guidance of a search from a prior.

    Parameters
    ----------
    tables : Tables
    probs : (n_rows, n_actions) float, optional
        Action probabilities by context, e.g. ``ActionPrior.probs``; rows sum to 1. Default: uniform, which
        gives the search without a prior.
    row : (n_states,) int, optional
        Row of each state in `probs`; default: the number of the state, or row 0 if `probs` has one row.
    rollout : {"uniform", "prior"}
        Distribution of the actions in a rollout.

    Raises
    ------
    InputError
        `probs` are no probabilities, `row` names a missing row, or `rollout` has another value.
    """
    if rollout not in ROLLOUTS:
        raise InputError(f"rollout must be one of {', '.join(ROLLOUTS)}, got '{rollout}'")
    flat = np.full((1, tables.n_actions), 1 / tables.n_actions)
    probs = np.ascontiguousarray(flat if probs is None else probs, np.float64)
    if probs.ndim != 2 or probs.shape[1] != tables.n_actions:
        raise InputError(f"probs must have {tables.n_actions} columns, one an action, got shape {probs.shape}")
    if not np.allclose(probs.sum(axis=1), 1, atol=1e-9) or (probs < 0).any():
        raise InputError("probs must hold probabilities: non-negative rows that sum to 1")
    if row is None:
        row = np.arange(tables.n_states) if len(probs) > 1 else np.zeros(tables.n_states)
    row = np.ascontiguousarray(row, np.int32)
    if row.shape != (tables.n_states,) or row.min() < 0 or row.max() >= len(probs):
        raise InputError(f"row must give each of {tables.n_states} states a row in [0, {len(probs)})")
    drawn = probs if rollout == "prior" else np.broadcast_to(flat, probs.shape)
    return SearchGuidance(probs, cumulative(drawn), row)


def search(
    tables: Tables, guide: SearchGuidance, state: int, settings: SearchSettings, generator: np.random.Generator
) -> SearchResult:
    """Search from `state` with a new tree; the same generator state gives the same result."""
    _check(tables, settings)
    if not 0 <= state < tables.n_states:
        raise InputError(f"state must lie in [0, {tables.n_states}), got {state}")
    tree = _new_tree(tables, settings.simulations)
    settings, random = _plain(settings), random_state(generator)
    _grow(tables.by_pair, guide, tree, int(state), settings, random)
    visits, total = tree.visits[0].copy(), tree.total[0]
    means = np.divide(total, visits, out=np.zeros_like(total), where=visits > 0)
    return SearchResult(int(_move(tree, settings.by_mean, random)), visits, means)


def play(
    tables: Tables,
    guide: SearchGuidance,
    start: int,
    settings: SearchSettings,
    max_steps: int,
    world: np.random.Generator,
    own: np.random.Generator,
) -> EpisodeResult:
    """One episode from `start` of at most `max_steps` moves, with a new search before every move.

    `world` draws the outcomes of the moves (none in a deterministic world), `own` the simulations of the search.
    """
    _check(tables, settings)
    if not 0 <= start < tables.n_states:
        raise InputError(f"start must lie in [0, {tables.n_states}), got {start}")
    if max_steps < 1:
        raise InputError(f"max_steps must be at least 1, got {max_steps}")
    tree = _new_tree(tables, settings.simulations)
    randoms = random_state(world), random_state(own)
    steps, reached, gained, bumps = _walk(
        tables.by_pair, guide, tree, int(start), _plain(settings), max_steps, *randoms
    )
    return EpisodeResult(int(steps), bool(reached), float(gained), int(bumps))


def _check(tables: Tables, settings: SearchSettings) -> None:
    if settings.simulations < 1 or settings.depth < 1:
        raise InputError(
            f"simulations and depth must be at least 1, got {settings.simulations} and {settings.depth}"
        )
    if not 0 <= settings.discount <= 1 or not 0 <= settings.exploration < np.inf:
        raise InputError(
            "discount must lie in [0, 1] and exploration be finite and at least 0, "
            f"got {settings.discount} and {settings.exploration}"
        )


def _plain(settings: SearchSettings) -> SearchSettings:
    """The settings converted to the types that the kernel is compiled for."""
    simulations, depth, exploration, discount, by_mean = settings
    return SearchSettings(int(simulations), int(depth), float(exploration), float(discount), bool(by_mean))


def _new_tree(tables: Tables, simulations: int) -> _Tree:
    n_nodes, n_actions = simulations + 1, tables.n_actions
    return _Tree(
        np.zeros(n_nodes, np.int32),
        np.zeros((n_nodes, n_actions, tables.n_outcomes), np.int32),
        np.zeros((n_nodes, n_actions), np.int64),
        np.zeros((n_nodes, n_actions)),
    )


@kernel
def _walk(tables, guide, tree, state, settings, max_steps, world, own):
    gained, factor, bumps = 0.0, 1.0, 0
    for moved in range(max_steps):
        _grow(tables, guide, tree, state, settings, own)
        action = _move(tree, settings.by_mean, own)
        k = _outcome(tables.outcome_cum, state, action, world)
        event = tables.event[state, action, k]
        gained += factor * tables.reward[state, action, k]
        factor *= settings.discount
        bumps += event & COLLISION > 0
        if event & TERMINAL:
            return moved + 1, True, gained, bumps
        state = tables.next_state[state, action, k]
    return max_steps, False, gained, bumps


@kernel
def _grow(tables, guide, tree, state, settings, random):
    """Clear `tree` and fill it with the simulations of one decision."""
    tree.child[:] = 0
    tree.visits[:] = 0
    tree.total[:] = 0.0
    tree.state[0] = state
    bounds = np.array([np.inf, -np.inf])
    nodes = np.empty(settings.depth, np.int64)
    actions = np.empty(settings.depth, np.int64)
    rewards = np.empty(settings.depth)
    used = 1
    for _ in range(settings.simulations):
        used = _simulate(tables, guide, tree, settings, random, bounds, nodes, actions, rewards, used)


@kernel
def _simulate(tables, guide, tree, settings, random, bounds, nodes, actions, rewards, used):
    """One simulation: select moves, add a node, roll out, update the means; return the number of nodes in use."""
    # Unpacked once, because reading an array of a tuple inside a loop would count references.
    next_state, reward, event, outcome_cum, _ = tables
    prior, _, row = guide
    states, child, visits, total = tree
    _, depth, exploration, discount, _ = settings
    node, n, beyond = 0, 0, 0.0
    while n < depth:
        state = states[node]
        action = _promising(visits, total, node, prior, row[state], exploration, bounds, random)
        k = _outcome(outcome_cum, state, action, random)
        nodes[n], actions[n], rewards[n] = node, action, reward[state, action, k]
        n += 1
        if event[state, action, k] & TERMINAL:
            break
        following = child[node, action, k]
        if following == 0:
            child[node, action, k] = used
            states[used] = next_state[state, action, k]
            beyond = _rollout(tables, guide, states[used], depth - n, discount, random)
            used += 1
            break
        node = following
    for i in range(n - 1, -1, -1):
        beyond = rewards[i] + discount * beyond
        visits[nodes[i], actions[i]] += 1
        total[nodes[i], actions[i]] += beyond
        mean = total[nodes[i], actions[i]] / visits[nodes[i], actions[i]]
        bounds[0] = min(bounds[0], mean)
        bounds[1] = max(bounds[1], mean)
    return used


@kernel
def _promising(visits, total, node, prior, row, exploration, bounds, random):
    """The action with the highest PUCT value; ties are broken at random."""
    low, high = bounds[0], bounds[1]
    n_actions = prior.shape[1]
    tried, summed = 0, 0.0
    for a in range(n_actions):
        tried += visits[node, a]
        summed += total[node, a]
    own = summed / tried if tried > 0 else 0.0
    spread = high - low
    wide = exploration * np.sqrt(max(1.0, float(tried)))
    best, equals, chosen = -np.inf, 0, 0
    for a in range(n_actions):
        n = visits[node, a]
        value = wide * prior[row, a] / (1.0 + n)
        if tried > 0 and spread > 0.0:
            value += ((total[node, a] / n if n > 0 else own) - low) / spread
        if value > best:
            best, equals, chosen = value, 1, a
        elif value == best:
            # The k-th tied action replaces the choice with probability 1/k, which makes all equally probable.
            equals += 1
            if uniform_integer(random, equals) == 0:
                chosen = a
    return chosen


@kernel
def _rollout(tables, guide, state, depth, discount, random):
    """Discounted return of at most `depth` randomly drawn moves."""
    next_state, reward, event, outcome_cum, _ = tables
    _, cum, row = guide
    last_action, last_outcome = cum.shape[1] - 1, outcome_cum.shape[2] - 1
    gained, factor = 0.0, 1.0
    for _ in range(depth):
        uniform, here, action, k = next_uniform(random), row[state], 0, 0
        while action < last_action and uniform >= cum[here, action]:
            action += 1
        if last_outcome > 0:
            uniform = next_uniform(random)
            while k < last_outcome and uniform >= outcome_cum[state, action, k]:
                k += 1
        gained += factor * reward[state, action, k]
        if event[state, action, k] & TERMINAL:
            break
        factor *= discount
        state = next_state[state, action, k]
    return gained


@kernel
def _outcome(outcome_cum, state, action, random):
    """Draw the outcome of a move; a deterministic world needs no random number."""
    last, k = outcome_cum.shape[2] - 1, 0
    if last > 0:
        uniform = next_uniform(random)
        while k < last and uniform >= outcome_cum[state, action, k]:
            k += 1
    return k


@kernel
def _move(tree, by_mean, random):
    """The root's action tried most, or the tried action with the best mean; ties are broken at random."""
    visits, total = tree.visits[0], tree.total[0]
    best, equals, chosen = -np.inf, 0, 0
    for a in range(visits.size):
        if visits[a] == 0:
            continue
        value = total[a] / visits[a] if by_mean else float(visits[a])
        if value > best:
            best, equals, chosen = value, 1, a
        elif value == best:
            equals += 1
            if uniform_integer(random, equals) == 0:
                chosen = a
    return chosen
