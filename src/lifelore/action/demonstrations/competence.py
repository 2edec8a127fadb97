"""Estimates the competence w(π) in [0, 1] of each demonstrator from the demonstrations.

There are two estimators. By steps, if the tasks can be solved:

    w = max(0, (h - e) / (n - e))

n is the number of an agent's steps in all tasks, h the number of best or tied-best steps among them, and e the
expected number of best steps of a uniform choice in the same states. A uniform choice has a weight of about 0, an
expert 1. By paths, if the tasks cannot be solved: the length of the shortest known path from the start to the end
of a demonstration, over the steps of all demonstrations of the task, as a share of the demonstration's own length;
w is the mean over the agent's demonstrations. An agent alone in a task gets 1, because no shorter path is known.
Thesis: §3.2.2.1 (w(π) as confidence), §3.4.8.
"""

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lifelore.action.demonstrations.demonstrations import Demonstration
from lifelore.core.errors import InputError


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
        best = np.asarray(best_of(one.task), bool)
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


def competence_by_paths(demonstrations: Sequence[Demonstration]) -> dict[str, float]:
    """w(π) of each agent by the length of its paths relative to the shortest known ones; needs no solution.

    Returns
    -------
    dict
        Agent to w in (0, 1].
    """
    shares: dict[str, list[float]] = {}
    for task in dict.fromkeys(one.task for one in demonstrations):
        same = [one for one in demonstrations if one.task == task]
        followers = _followers(same)
        for one in same:
            shortest = _distance(followers, int(one.states[0]), int(one.states[-1]))
            # The last action leaves the last recorded state, so a path of n states has n steps.
            shares.setdefault(one.agent, []).append((shortest + 1) / len(one.states))
    return {agent: float(np.mean(own)) for agent, own in shares.items()}


def _followers(demonstrations: Iterable[Demonstration]) -> dict[int, set[int]]:
    followers: dict[int, set[int]] = {}
    for one in demonstrations:
        states = one.states.tolist()
        for state, following in pairwise(states):
            followers.setdefault(state, set()).add(following)
    return followers


def _distance(followers: dict[int, set[int]], start: int, end: int) -> int:
    """Steps of the shortest path; the demonstration itself is a path."""
    distance, frontier, seen = 0, {start}, {start}
    while end not in frontier:
        frontier = {following for state in frontier for following in followers.get(state, ())} - seen
        seen |= frontier
        distance += 1
    return distance
