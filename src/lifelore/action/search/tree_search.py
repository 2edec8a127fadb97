"""Monte-Carlo tree search on tables, guided by an action prior (PUCT).

At a node visited N times the search takes the action that maximises

    q(a) + c P(s, a) √max(1, N) / (1 + n(a))

q(a) is the mean discounted return beyond the action, put to [0, 1] by the least and largest mean of this search,
so that c needs no unit; an action not yet tried counts as the node's own mean. P is the prior's row of the state's
context, n(a) how often the action was tried. Each simulation adds one node and ends in a rollout, drawn
uniformly or from the prior. Equals are chosen among at random.

The prior here is the thesis's action prior: how often an action was useful in a context, over tasks. It knows
nothing of the task at hand; that knowledge comes from the simulations alone. Thesis: §3.8, §5.2.
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


class Guidance(NamedTuple):
    """What a prior tells the search.

    prior : (n_rows, n_actions) float64, P(s, a) by context; rows sum to 1
    rollout_cum : (n_rows, n_actions) float64, cumulative probabilities of a rollout's actions
    row : (n_states,) int32, row of the two arrays above that each state reads
    """

    prior: NDArray[np.float64]
    rollout_cum: NDArray[np.float64]
    row: NDArray[np.int32]


class SearchSettings(NamedTuple):
    """How much is searched and what move follows.

    simulations : int, for each move, at least 1
    depth : int, moves that a simulation looks ahead, at least 1
    exploration : float, c, at least 0
    discount : float, γ in [0, 1]
    by_mean : bool, make the move of the best mean instead of the one tried most
    """

    simulations: int = 200
    depth: int = 50
    exploration: float = 1.25
    discount: float = 0.95
    by_mean: bool = False


class Searched(NamedTuple):
    """What a search found at its root.

    action : int, the one tried most (or of the best mean), of equals one at random
    visits : (n_actions,) int64, how often each was tried; they sum to the simulations
    means : (n_actions,) float64, mean discounted return of each; 0 where never tried
    """

    action: int
    visits: NDArray[np.int64]
    means: NDArray[np.float64]


class Played(NamedTuple):
    """An episode of a searching agent: moves made, whether it ended at a terminal move, discounted return."""

    steps: int
    reached: bool
    discounted_return: float
    collisions: int


class _Tree(NamedTuple):
    """Nodes by number, the root 0. `child` holds 0 where there is none: the root is nobody's child."""

    state: NDArray[np.int32]
    child: NDArray[np.int32]
    visits: NDArray[np.int64]
    total: NDArray[np.float64]


def guidance(
    tables: Tables, probs: ArrayLike | None = None, row: ArrayLike | None = None, rollout: str = "prior"
) -> Guidance:
    """What a prior tells the search.

    Parameters
    ----------
    tables : Tables
    probs : (n_rows, n_actions) float, optional
        Action probabilities by context, e.g. ``ActionPrior.probs``; rows sum to 1. Default: uniform, which
        gives the search without a prior.
    row : (n_states,) int, optional
        Row of `probs` that each state reads; default: the state's own number, or row 0 if `probs` has one row.
    rollout : {"uniform", "prior"}
        What a rollout's actions are drawn from.

    Raises
    ------
    InputError
        `probs` are no probabilities, `row` names a row that is not there, or `rollout` is neither.
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
    return Guidance(probs, cumulative(drawn), row)


def search(
    tables: Tables, guide: Guidance, state: int, settings: SearchSettings, generator: np.random.Generator
) -> Searched:
    """Search from `state`; the tree is new. The same generator state gives the same search."""
    _check(tables, settings)
    if not 0 <= state < tables.n_states:
        raise InputError(f"state must lie in [0, {tables.n_states}), got {state}")
    tree = _new_tree(tables, settings.simulations)
    settings, random = _plain(settings), random_state(generator)
    _grow(tables, guide, tree, int(state), settings, random)
    visits, total = tree.visits[0].copy(), tree.total[0]
    means = np.divide(total, visits, out=np.zeros_like(total), where=visits > 0)
    return Searched(int(_move(tree, settings.by_mean, random)), visits, means)


def play(
    tables: Tables,
    guide: Guidance,
    start: int,
    settings: SearchSettings,
    max_steps: int,
    world: np.random.Generator,
    own: np.random.Generator,
) -> Played:
    """One episode from `start`, searched anew before every move, of at most `max_steps` moves.

    `world` draws what happens (nothing where the world is deterministic), `own` what the search imagines.
    """
    _check(tables, settings)
    if not 0 <= start < tables.n_states:
        raise InputError(f"start must lie in [0, {tables.n_states}), got {start}")
    if max_steps < 1:
        raise InputError(f"max_steps must be at least 1, got {max_steps}")
    tree = _new_tree(tables, settings.simulations)
    randoms = random_state(world), random_state(own)
    steps, reached, gained, bumps = _walk(tables, guide, tree, int(start), _plain(settings), max_steps, *randoms)
    return Played(int(steps), bool(reached), float(gained), int(bumps))


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
    """Of the types that the kernel is compiled for, whatever came."""
    simulations, depth, exploration, discount, by_mean = settings
    return SearchSettings(int(simulations), int(depth), float(exploration), float(discount), bool(by_mean))


def _new_tree(tables: Tables, simulations: int) -> _Tree:
    n_nodes, n_actions = simulations + 1, tables.n_actions
    return _Tree(
        np.zeros(n_nodes, np.int32),
        np.zeros((n_nodes, n_actions, tables.outcome_cum.size), np.int32),
        np.zeros((n_nodes, n_actions), np.int64),
        np.zeros((n_nodes, n_actions)),
    )


@kernel
def _walk(tables, guide, tree, state, settings, max_steps, world, own):
    gained, worth, bumps = 0.0, 1.0, 0
    for moved in range(max_steps):
        _grow(tables, guide, tree, state, settings, own)
        action = _move(tree, settings.by_mean, own)
        k = _outcome(tables, world)
        event = tables.event[state, action, k]
        gained += worth * tables.reward[state, action, k]
        worth *= settings.discount
        bumps += event & COLLISION > 0
        if event & TERMINAL:
            return moved + 1, True, gained, bumps
        state = tables.next_state[state, action, k]
    return max_steps, False, gained, bumps


@kernel
def _grow(tables, guide, tree, state, settings, random):
    """Fill `tree`, whatever it held, with the simulations of one decision."""
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
    """One simulation: down the tree, a new node, a rollout, and back up; returns the nodes now used."""
    node, n, beyond = 0, 0, 0.0
    while n < settings.depth:
        state = tree.state[node]
        action = _promising(tree, node, guide.prior, guide.row[state], settings.exploration, bounds, random)
        k = _outcome(tables, random)
        nodes[n], actions[n], rewards[n] = node, action, tables.reward[state, action, k]
        n += 1
        if tables.event[state, action, k] & TERMINAL:
            break
        following = tree.child[node, action, k]
        if following == 0:
            tree.child[node, action, k] = used
            tree.state[used] = tables.next_state[state, action, k]
            beyond = _rollout(tables, guide, tree.state[used], settings.depth - n, settings.discount, random)
            used += 1
            break
        node = following
    for i in range(n - 1, -1, -1):
        beyond = rewards[i] + settings.discount * beyond
        tree.visits[nodes[i], actions[i]] += 1
        tree.total[nodes[i], actions[i]] += beyond
        mean = tree.total[nodes[i], actions[i]] / tree.visits[nodes[i], actions[i]]
        bounds[0] = min(bounds[0], mean)
        bounds[1] = max(bounds[1], mean)
    return used


@kernel
def _promising(tree, node, prior, row, exploration, bounds, random):
    """The action of the highest PUCT value, one of the equals at random."""
    _, _, visits, total = tree
    n_actions = prior.shape[1]
    tried, worth = 0, 0.0
    for a in range(n_actions):
        tried += visits[node, a]
        worth += total[node, a]
    own = worth / tried if tried > 0 else 0.0
    spread = bounds[1] - bounds[0]
    wide = exploration * np.sqrt(max(1.0, float(tried)))
    best, equals, chosen = -np.inf, 0, 0
    for a in range(n_actions):
        n = visits[node, a]
        value = wide * prior[row, a] / (1.0 + n)
        if tried > 0 and spread > 0.0:
            value += ((total[node, a] / n if n > 0 else own) - bounds[0]) / spread
        if value > best:
            best, equals, chosen = value, 1, a
        elif value == best:
            # The k-th of the equals takes the place with chance 1/k: each is as likely in the end.
            equals += 1
            if uniform_integer(random, equals) == 0:
                chosen = a
    return chosen


@kernel
def _rollout(tables, guide, state, depth, discount, random):
    """Discounted return of at most `depth` moves drawn without looking."""
    next_state, reward, event, outcome_cum, _ = tables
    _, cum, row = guide
    last_action, last_outcome = cum.shape[1] - 1, outcome_cum.size - 1
    gained, worth = 0.0, 1.0
    for _ in range(depth):
        uniform, here, action, k = next_uniform(random), row[state], 0, 0
        while action < last_action and uniform >= cum[here, action]:
            action += 1
        if last_outcome > 0:
            uniform = next_uniform(random)
            while k < last_outcome and uniform >= outcome_cum[k]:
                k += 1
        gained += worth * reward[state, action, k]
        if event[state, action, k] & TERMINAL:
            break
        worth *= discount
        state = next_state[state, action, k]
    return gained


@kernel
def _outcome(tables, random):
    """The outcome of a move; a deterministic world draws nothing."""
    last, k = tables.outcome_cum.size - 1, 0
    if last > 0:
        uniform = next_uniform(random)
        while k < last and uniform >= tables.outcome_cum[k]:
            k += 1
    return k


@kernel
def _move(tree, by_mean, random):
    """The root's action tried most or, of those tried, the one of the best mean; one of the equals at random."""
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
