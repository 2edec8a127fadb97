"""Exact mean and deviation of the return of a policy over whole episodes with a step limit.

Policies map observations to actions: each hidden state of the tables reads one row. Without a discount, a policy
that may never end has no value over an infinite horizon; up to the step limit it has.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.mdp import TERMINAL, Tables

ENDED = -1
"""Instead of a next state: the episode is over."""


def return_moments(
    tables: Tables, row_of: NDArray[np.int32], probs: NDArray[np.float64], max_steps: int, discount: float = 1.0
) -> tuple[float, float]:
    """Mean and standard deviation of an episode's return: probability pushed forward from the starts.

    Parameters
    ----------
    tables : Tables
    row_of : (n_states,) int32
        Row of `probs` that the policy reads in a state.
    probs : (n_rows, n_actions) float64
        The policy; rows sum to 1.
    max_steps : int
        Steps after which an episode is truncated.
    discount : float
        γ in [0, 1].
    """
    first, second = _moments(tables.by_pair, row_of, probs, max_steps, discount)
    return float(first), float(np.sqrt(max(second - first**2, 0.0)))


@kernel
def _moments(tables, row_of, probs, max_steps, discount):
    """First and second moment of the return; touches only the states that can be reached so far."""
    n_states, starts = tables.next_state.shape[0], tables.starts
    begin, following, chance, reward_of = _followed(tables, row_of, probs)
    # Per state: its probability, and that times the return so far and its square.
    here, there = np.zeros((n_states, 3)), np.zeros((n_states, 3))
    active, found = np.empty(n_states, np.int64), np.empty(n_states, np.int64)
    listed = np.full(n_states, -1, np.int64)
    n_active, first, second, weight_of_step = 0, 0.0, 0.0, 1.0
    for s in starts:
        if here[s, 0] == 0.0:
            active[n_active] = s
            n_active += 1
        here[s, 0] += 1.0 / starts.size
    for step in range(max_steps):
        n_found = 0
        for i in range(n_active):
            s = active[i]
            mass, sum1, sum2 = here[s, 0], here[s, 1], here[s, 2]
            here[s, 0], here[s, 1], here[s, 2] = 0.0, 0.0, 0.0
            # Unsigned, because Numba checks every signed index for counting from the end.
            for j in range(np.uint64(begin[s]), np.uint64(begin[s + 1])):
                w, r = chance[j], weight_of_step * reward_of[j]
                gained1, gained2 = w * (sum1 + r * mass), w * (sum2 + 2.0 * r * sum1 + r * r * mass)
                if following[j] == ENDED:
                    first += gained1
                    second += gained2
                    continue
                s2 = np.uint64(following[j])
                if listed[s2] != step:
                    listed[s2] = step
                    found[n_found] = s2
                    n_found += 1
                there[s2, 0] += w * mass
                there[s2, 1] += gained1
                there[s2, 2] += gained2
        here, there = there, here
        active, found = found, active
        n_active = n_found
        weight_of_step *= discount
    for i in range(n_active):
        first += here[active[i], 1]
        second += here[active[i], 2]
    return first, second


@kernel
def _followed(tables, row_of, probs):
    """What a policy makes of the tables; the entries of state s are ``begin[s]`` … ``begin[s + 1]`` - 1.

    Equal outcomes in a row are merged: a third of the work where there are many.

    Returns
    -------
    begin : (n_states + 1,) int32
    following : (n,) int32
        The next state, or `ENDED`.
    chance, reward : (n,) float64
        The probability of an entry in its state, and its reward.
    """
    next_state, reward_of, event_of, outcome_cum, _ = tables
    n_states, n_actions, n_outcomes = next_state.shape
    begin, n = np.zeros(n_states + 1, np.int32), 0
    for s in range(n_states):
        n += n_outcomes * np.count_nonzero(probs[row_of[s]])
    following, chance, reward = np.empty(n, np.int32), np.empty(n), np.empty(n)
    n = 0
    for s in range(n_states):
        for a in range(n_actions):
            chosen = probs[row_of[s], a]
            if chosen == 0.0:
                continue
            below = 0.0
            for k in range(n_outcomes):
                again = k + 1 < n_outcomes and next_state[s, a, k + 1] == next_state[s, a, k]
                again = again and reward_of[s, a, k + 1] == reward_of[s, a, k]
                if again and event_of[s, a, k + 1] == event_of[s, a, k]:
                    continue
                following[n] = ENDED if event_of[s, a, k] & TERMINAL else next_state[s, a, k]
                chance[n], reward[n] = chosen * (outcome_cum[s, a, k] - below), reward_of[s, a, k]
                below = outcome_cum[s, a, k]
                n += 1
        begin[s + 1] = n
    return begin, following, chance, reward
