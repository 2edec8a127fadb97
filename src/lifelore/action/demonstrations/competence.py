"""Estimates the competence w(π) in [0, 1] of each demonstrator from the demonstrations of solved tasks:

    w = max(0, (h - e) / (n - e))

n is the number of an agent's steps in all tasks, h the number of best or tied-best steps among them, and e the
expected number of best steps of a uniform choice in the same states. A uniform choice has a weight of about 0, an
expert 1. Thesis: §3.2.2.1 (w(π) as confidence), §3.4.8.
"""

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from lifelore.action.demonstrations.demonstrations import Demonstration
from lifelore.core.errors import InputError
from lifelore.core.planning.planning import checked_best


def competence_by_steps(
    demonstrations: Iterable[Demonstration], best_of: Callable[[str], NDArray[np.bool_]]
) -> dict[str, float]:
    """w(π) of each agent by its share of best steps, corrected for chance.

    Parameters
    ----------
    demonstrations : iterable of Demonstration
    best_of : callable
        A task's name to its best or tied-best actions, (n_states, n_actions) bool. Steps in states without
        best actions (goals, completed configurations) are skipped, and so are steps where every action is best.

    Returns
    -------
    dict
        Agent to w in [0, 1]; 0 for an agent without a step that counts.
    """
    found: dict[str, list[float]] = {}
    for one in demonstrations:
        best = checked_best(best_of(one.task))
        if one.states.size and (one.states.max() >= len(best) or one.actions.max() >= best.shape[1]):
            raise InputError(
                f"demonstration of '{one.agent}' in task '{one.task}' must stay within its {len(best)} states and "
                f"{best.shape[1]} actions, got {one.states.max()} and {one.actions.max()}"
            )
        share = best[one.states].mean(axis=1)
        counts_for_w = (share > 0) & (share < 1)
        hits = best[one.states, one.actions][counts_for_w]
        total = found.setdefault(one.agent, [0.0, 0.0, 0.0])
        for i, value in enumerate((hits.sum(), share[counts_for_w].sum(), counts_for_w.sum())):
            total[i] += float(value)
    return {agent: max(0.0, (h - e) / (n - e)) if n else 0.0 for agent, (h, e, n) in found.items()}
