"""Simulates people who demonstrate a task; each has a skill and otherwise acts at random.

    π(a | s) = skill · [a is best in s] / (number of best in s) + (1 - skill) / |A|

Experiments that use simulated people say so in their results. Thesis: §3.4.8.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.demonstrations.demonstrations import Demonstration
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.planning.planning import checked_best


def person_policy(best: ArrayLike, skill: float) -> NDArray[np.float64]:
    """Action probabilities of a person, (n_states, n_actions), rows sum to 1; uniform without best action."""
    best = checked_best(best)
    known = best | ~best.any(axis=1, keepdims=True)
    return skill * known / known.sum(axis=1, keepdims=True) + (1 - skill) / best.shape[1]


def simulated_demonstration(
    tables: Tables,
    best: ArrayLike,
    skill: float,
    generator: np.random.Generator,
    *,
    task: str,
    agent: str,
    most_steps: int,
) -> Demonstration | None:
    """One demonstration from a start to the end of the episode; None if it takes more than `most_steps` steps.

    Parameters
    ----------
    tables : Tables
    best : (n_states, n_actions) bool
        Best or tied-best actions.
    skill : float
        In [0, 1]: 0 chooses uniformly, 1 is an expert.
    generator : numpy generator
    task, agent : str
        Names in the demonstration.
    most_steps : int
        Number of steps after which the person gives up, at least 1.
    """
    cum, outcome_cum = np.cumsum(person_policy(best, skill), axis=1), tables.by_pair.outcome_cum
    state = int(generator.choice(tables.starts))
    states, actions = [], []
    for _ in range(most_steps):
        choice, outcome = generator.random(2)
        action = int((choice * cum[state, -1] >= cum[state, :-1]).sum())
        k = int((outcome >= outcome_cum[state, action, :-1]).sum())
        states.append(state)
        actions.append(action)
        if tables.event[state, action, k] & TERMINAL:
            return Demonstration(task, agent, np.array(states, np.int64), np.array(actions, np.int64))
        state = int(tables.next_state[state, action, k])
    return None
