"""Returns of sampled episodes of a fixed policy over observations."""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.mdp import TERMINAL, Tables


def episode_returns(
    tables: Tables,
    row_of: NDArray[np.int32],
    policy_cum: NDArray[np.float64],
    max_steps: int,
    n_episodes: int,
    *,
    world: np.random.Generator,
    own: np.random.Generator,
) -> NDArray[np.float64]:
    """Undiscounted returns of episodes, (n_episodes,) float64.

    Parameters
    ----------
    tables : Tables
    row_of : (n_states,) int32
        Row of `policy_cum` that the policy reads in a state.
    policy_cum : (n_rows, n_actions) float64
        Cumulative probabilities of the actions, last column 1 (`core.q_learning.cumulative`).
    max_steps, n_episodes : int
    world, own : numpy generators
        Draws of starts and outcomes; draws of the policy.
    """
    return _run(tables.by_pair, row_of, policy_cum, max_steps, n_episodes, random_state(world), random_state(own))


@kernel
def _run(tables, row_of, policy_cum, max_steps, n_episodes, world, own):
    next_state, reward_of, event_of, outcome_cum, starts = tables
    n_outcomes = next_state.shape[2]
    returns = np.zeros(n_episodes)
    for episode in range(n_episodes):
        s = starts[int(next_uniform(world) * starts.size)]
        for _ in range(max_steps):
            u = next_uniform(own)
            a = 0
            while u >= policy_cum[row_of[s], a]:
                a += 1
            k = 0
            if n_outcomes > 1:
                u = next_uniform(world)
                while u >= outcome_cum[s, a, k]:
                    k += 1
            returns[episode] += reward_of[s, a, k]
            if event_of[s, a, k] & TERMINAL:
                break
            s = next_state[s, a, k]
    return returns
