"""ε-greedy Q-learning over tables: one kernel for every domain, prior-guided or not.

    Q(s, a) ← Q(s, a) + α [r + γ max_a' Q(s', a') - Q(s, a)]

The kernel reads one row of exploration probabilities and one row of tie weights per context; `Rows` says which
row belongs to which state. The row of Q and the row of the context are separate, so a learner may observe less
than the hidden state, and a context may include the class of the last reward. Learning is resumable: `learn` runs
a bounded number of steps and stores its state in `QLearner`. Thesis: §3.2.2.3, Alg. 2 and 4.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.errors import InputError
from lifelore.core.learning.curve import DISCOUNT, EPISODE, RETURN, REWARD_CLASS, STATE, STEP, TOTAL
from lifelore.core.mdp import COLLISION, TERMINAL, Tables


class Rows(NamedTuple):
    """Which row of Q and of the prior a state reads, and the prior itself.

    q_row : (n_states,) int32, row of Q that the learner reads in a state
    context_row : (n_states, n_reward_classes) int32, row of the two arrays below
    reward_class : (n_states, n_actions, n_outcomes) uint8, class of the last reward
    explore_cum : (n_contexts, n_actions) float64, cumulative exploration probabilities
    tie_weight : (n_contexts, n_actions) float64, positive; relative odds among tied best actions
    """

    q_row: NDArray[np.int32]
    context_row: NDArray[np.int32]
    reward_class: NDArray[np.uint8]
    explore_cum: NDArray[np.float64]
    tie_weight: NDArray[np.float64]


class Schedule(NamedTuple):
    """Per episode: exploration ε and learning rate α, both (n_episodes,) in [0, 1]; and the step cap."""

    epsilon: NDArray[np.float64]
    alpha: NDArray[np.float64]
    max_steps: int
    discount: float


class QLearner(NamedTuple):
    """State of a learner between two calls of `learn`; changed in place.

    q : (n_q_rows, n_actions) float64
    visits : (n_q_rows, n_actions) int64
    world_random, own_random : (2,) uint64, the world's stream (starts, outcomes) and the learner's own
    cursor : (5,) int64, see `curve.EPISODE` and the constants beside it
    running : (2,) float64, see `curve.RETURN`
    """

    q: NDArray[np.float64]
    visits: NDArray[np.int64]
    world_random: NDArray[np.uint64]
    own_random: NDArray[np.uint64]
    cursor: NDArray[np.int64]
    running: NDArray[np.float64]


def uniform_rows(tables: Tables, explore=None, ties=None, context_row=None) -> Rows:
    """Rows for a learner that observes the state and whose context ignores rewards.

    Parameters
    ----------
    tables : Tables
    explore : (n_contexts, n_actions) float, optional
        Exploration probabilities, rows sum to 1; default uniform.
    ties : (n_contexts, n_actions) float, optional
        Positive tie weights; default uniform.
    context_row : (n_states,) int, optional
        Row of `explore` and `ties` read in each state; default: the state's own number if `explore` has
        one row a state, else row 0.
    """
    n_states, n_actions = tables.n_states, tables.n_actions
    explore = np.full((1, n_actions), 1 / n_actions) if explore is None else np.asarray(explore, float)
    ties = np.ones_like(explore) if ties is None else np.asarray(ties, float)
    if context_row is None:
        context_row = np.arange(n_states) if len(explore) == n_states else np.zeros(n_states)
    context_row = np.ascontiguousarray(context_row, dtype=np.int32)
    _check_rows(explore, ties, n_actions)
    _check_context_row(context_row, n_states, len(explore))
    return Rows(
        np.arange(n_states, dtype=np.int32),
        context_row[:, None],
        np.zeros(tables.next_state.shape, np.uint8),
        cumulative(explore),
        np.ascontiguousarray(ties),
    )


def cumulative(probs: NDArray[np.float64]) -> NDArray[np.float64]:
    """Row-wise cumulative sums whose last entry is exactly 1."""
    cum = np.cumsum(probs, axis=1)
    cum[:, -1] = 1.0
    return np.ascontiguousarray(cum)


def _check_rows(explore: NDArray[np.float64], ties: NDArray[np.float64], n_actions: int) -> None:
    if explore.ndim != 2 or explore.shape[1] != n_actions:
        raise InputError(f"explore must have {n_actions} columns, one an action, got shape {explore.shape}")
    if explore.shape != ties.shape:
        raise InputError(f"explore and ties must agree in shape, got {explore.shape} and {ties.shape}")
    if not np.allclose(explore.sum(axis=1), 1, atol=1e-9) or (explore < 0).any():
        raise InputError("explore must hold probabilities: non-negative rows that sum to 1")
    if not (ties > 0).all():
        raise InputError("ties must be positive: an action of weight 0 could never be chosen among equals")


def _check_context_row(row: NDArray[np.int32], n_states: int, n_contexts: int) -> None:
    # A row out of range would read foreign memory inside the kernel.
    if row.shape != (n_states,) or row.min() < 0 or row.max() >= n_contexts:
        raise InputError(
            f"context_row must give each of {n_states} states a row in [0, {n_contexts}), "
            f"got shape {row.shape}, {row.min(initial=0)}..{row.max(initial=0)}"
        )


def new_learner(n_q_rows: int, n_actions: int, world, own) -> QLearner:
    """A learner at the start of its first episode, Q = 0; `world` and `own` are numpy generators."""
    return QLearner(
        np.zeros((n_q_rows, n_actions)),
        np.zeros((n_q_rows, n_actions), np.int64),
        random_state(world),
        random_state(own),
        np.zeros(5, np.int64),
        np.zeros(2),
    )


@inlined
def epsilon_greedy(q, row, explore_cum, tie_weight, context, epsilon, random):
    """ε-greedy action (Alg. 2 line 5): explore by the prior, else a best action, ties by weight."""
    if epsilon > 0.0 and next_uniform(random) < epsilon:
        return _drawn(explore_cum, context, next_uniform(random))
    best, tied = _first_best(q, row)
    return _drawn_tie(q, row, tie_weight, context, best, random) if tied > 1 else best


@inlined
def _drawn(cumulative_probs, context, u):
    """The action at the place `u` in [0, 1) of a row of cumulative probabilities."""
    a = 0
    while u >= cumulative_probs[context, a]:
        a += 1
    return a


@inlined
def _first_best(q, row):
    """The first best action of a row of Q, and the number of best ones."""
    best, best_value, tied = 0, q[row, 0], 1
    for a in range(1, q.shape[1]):
        value = q[row, a]
        if value > best_value:
            best, best_value, tied = a, value, 1
        elif value == best_value:
            tied += 1
    return best, tied


@inlined
def _drawn_tie(q, row, tie_weight, context, first, random):
    """Draw among the actions tied with `first`, the first of them, by their tie weights."""
    best_value = q[row, first]
    total = 0.0
    for a in range(first, q.shape[1]):
        if q[row, a] == best_value:
            total += tie_weight[context, a]
    left = next_uniform(random) * total
    chosen = first
    for a in range(first, q.shape[1]):
        if q[row, a] == best_value and left >= 0.0:
            chosen = a
            left -= tie_weight[context, a]
    return chosen


@kernel
def learn(tables, rows, schedule, learner, curve, budget):
    """Run at most `budget` steps; returns how many were run, fewer once the last episode is over."""
    # Unpacked once, because reading an array of a tuple inside the loop would count references at every step.
    next_state, reward_of, event_of, outcome_cum, starts = tables
    cum = np.broadcast_to(outcome_cum, next_state.shape)  # one row may serve all states and actions
    n_outcomes = next_state.shape[2]
    q_row, context_row, class_of, explore_cum, tie_weight = rows
    epsilons, alphas, max_steps, gamma = schedule
    q, visits, world, own, cursor, running = learner
    returns, rewards, steps, collisions, reached = curve
    # Unsigned, because Numba checks every signed index for counting from the end.
    episode, step = cursor[EPISODE], cursor[STEP]
    state, reward_class = np.uint64(cursor[STATE]), np.uint64(cursor[REWARD_CLASS])
    ret, discount = running[RETURN], running[DISCOUNT]
    done_steps = 0
    while done_steps < budget and episode < epsilons.size:
        if step == 0:
            state = np.uint64(starts[np.int64(next_uniform(world) * starts.size)])
            reward_class, ret, discount = np.uint64(0), 0.0, 1.0
        row = np.uint64(q_row[state])
        context = np.uint64(context_row[state, reward_class])
        epsilon = epsilons[episode]
        # The rule of `epsilon_greedy`: to pass the arrays on would count references at every step.
        if epsilon > 0.0 and next_uniform(own) < epsilon:
            a = _drawn(explore_cum, context, next_uniform(own))
        else:
            a, tied = _first_best(q, row)
            if tied > 1:
                a = _drawn_tie(q, row, tie_weight, context, a, own)
        k = 0
        if n_outcomes > 1:
            u = next_uniform(world)
            while u >= cum[state, a, k]:
                k += 1
        following = np.uint64(next_state[state, a, k])
        reward = reward_of[state, a, k]
        event = event_of[state, a, k]
        target = reward
        if not event & TERMINAL:
            target += gamma * _best_value(q, np.uint64(q_row[following]))
        q[row, a] += alphas[episode] * (target - q[row, a])
        visits[row, a] += 1
        ret += discount * reward
        discount *= gamma
        rewards[episode] += reward
        if event & COLLISION:
            collisions[episode] += 1
        reward_class = np.uint64(class_of[state, a, k])
        state = following
        step += 1
        done_steps += 1
        if event & TERMINAL or step >= max_steps:
            returns[episode] = ret
            steps[episode] = step
            reached[episode] = event & TERMINAL > 0
            episode += 1
            step = 0
    cursor[EPISODE], cursor[STEP], cursor[STATE], cursor[REWARD_CLASS] = episode, step, state, reward_class
    cursor[TOTAL] += done_steps
    running[RETURN], running[DISCOUNT] = ret, discount
    return done_steps


@inlined
def _best_value(q, row):
    best = q[row, 0]
    for a in range(1, q.shape[1]):
        if q[row, a] > best:
            best = q[row, a]
    return best
