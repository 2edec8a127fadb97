"""Simulated people who show a task: noisily rational, each with a skill.

    π(a | s) = skill · [a is best in s] / (number of best in s) + (1 - skill) / |A|

They stand in for people in experiments, and what is measured with them says so. Thesis: §3.4.8.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.demonstrations.demonstrations import Demonstration
from lifelore.core.errors import InputError
from lifelore.core.mdp import TERMINAL, Tables


def person_policy(best: ArrayLike, skill: float) -> NDArray[np.float64]:
    """Action probabilities of a person, (n_states, n_actions), rows sum to 1; blind where nothing is best."""
    best = np.asarray(best, bool)
    if not 0 <= skill <= 1:
        raise InputError(f"skill must lie in [0, 1], got {skill}")
    known = best | ~best.any(axis=1, keepdims=True)
    return skill * known / known.sum(axis=1, keepdims=True) + (1 - skill) / best.shape[1]


def shown_by_person(
    tables: Tables,
    best: ArrayLike,
    skill: float,
    generator: np.random.Generator,
    *,
    task: str,
    agent: str,
    start: int | None = None,
    most_steps: int = 1000,
) -> Demonstration | None:
    """One demonstration, from a start to the end of the episode; None if `most_steps` did not end it.

    Parameters
    ----------
    tables : Tables
    best : (n_states, n_actions) bool
        Best or tied-best actions.
    skill : float
        In [0, 1]: 0 acts blindly, 1 is an expert.
    generator : numpy generator
    task, agent : str
        Names in the demonstration.
    start : int, optional
        Default: drawn from the task's starts.
    most_steps : int
        At least 1: people give up.
    """
    if most_steps < 1:
        raise InputError(f"most_steps must be at least 1, got {most_steps}")
    cum = np.cumsum(person_policy(best, skill), axis=1)
    state = int(generator.choice(tables.starts)) if start is None else int(start)
    states, actions = [], []
    for _ in range(most_steps):
        choice, outcome = generator.random(2)
        action = int((choice * cum[state, -1] >= cum[state, :-1]).sum())
        k = int((outcome >= tables.outcome_cum[:-1]).sum())
        states.append(state)
        actions.append(action)
        if tables.event[state, action, k] & TERMINAL:
            return Demonstration(task, agent, np.array(states, np.int64), np.array(actions, np.int64))
        state = int(tables.next_state[state, action, k])
    return None
