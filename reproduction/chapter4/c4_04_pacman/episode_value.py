"""Exact mean and deviation of the return of a policy over whole episodes with a step limit.

Policies map observations to actions: each hidden state of the tables reads one row. Without a discount, a policy
that may never end has no value over an infinite horizon; up to the step limit it has.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from lifelore.core.mdp import TERMINAL, Tables


def return_moments(
    tables: Tables, row_of: NDArray[np.int32], probs: NDArray[np.float64], max_steps: int
) -> tuple[float, float]:
    """Mean and standard deviation of an episode's return.

    The moments of what is still to come, by state and backwards from the step limit:
    ``E[G] = E[r + G']`` and ``E[G²] = E[r² + 2 r G' + G'²]``.

    Parameters
    ----------
    tables : Tables
    row_of : (n_states,) int32
        Row of `probs` that the policy reads in a state.
    probs : (n_rows, n_actions) float64
        The policy; rows sum to 1.
    max_steps : int
        Steps after which an episode is truncated.
    """
    chances = np.diff(tables.by_pair.outcome_cum, prepend=0.0) * probs[row_of][:, :, None]
    state, action, outcome = np.nonzero(chances)
    chance, reward = chances[state, action, outcome], tables.reward[state, action, outcome]
    goes_on = (tables.event[state, action, outcome] & TERMINAL) == 0
    way = state[goes_on], tables.next_state[state, action, outcome][goes_on]
    shape = tables.n_states, tables.n_states
    onward, paid_onward = (csr_array((x[goes_on], way), shape=shape) for x in (chance, chance * reward))
    now, square_now = (np.bincount(state, chance * x, tables.n_states) for x in (reward, reward**2))
    first, second = np.zeros((2, tables.n_states))
    for _ in range(max_steps):
        second = square_now + 2 * (paid_onward @ first) + onward @ second
        first = now + onward @ first
    mean = first[tables.starts].mean()
    return float(mean), float(np.sqrt(max(second[tables.starts].mean() - mean**2, 0.0)))
