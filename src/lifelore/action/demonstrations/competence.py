"""How far to trust each demonstrator: w(π) in [0, 1] from what they did.

Two estimators. Where the tasks can be solved, by steps:

    w = max(0, (h - e) / (n - e))

with n steps of an agent in all tasks, h of them best or tied best (in a world of moves: they shorten the way),
and e the number that choosing blindly would have made best in the same states. Someone who chooses blindly weighs
about 0, an expert 1. Where they cannot, by ways: the shortest known way from where a demonstration began to where
it ended, over the steps of all demonstrations of the task, as a share of its own length; the mean of an agent's.
It trusts whoever is alone: nothing shorter is known. Thesis: §3.2.2.1 (w(π) as confidence), §3.4.8.
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
        A task's name to its best or tied-best actions, (n_states, n_actions) bool. Steps in states without any
        (goals, completed configurations) are passed over, and so are those where every action is best.

    Returns
    -------
    dict
        Agent to w in [0, 1]; 0 for an agent without a step that tells.
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
        tells = (share > 0) & (share < 1)
        hits = best[one.states, one.actions][tells]
        total = found.setdefault(one.agent, [0.0, 0.0, 0.0])
        for i, value in enumerate((hits.sum(), share[tells].sum(), tells.sum())):
            total[i] += float(value)
    return {agent: max(0.0, (h - e) / (n - e)) if n else 0.0 for agent, (h, e, n) in found.items()}


def competence_by_ways(demonstrations: Sequence[Demonstration]) -> dict[str, float]:
    """w(π) of each agent by the length of its ways beside the shortest known ones; needs no solution.

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
            # The last action leads out of the last state told, so a way of n states has n steps.
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
    """Steps of the shortest way; there is one, the demonstration's own."""
    distance, frontier, seen = 0, {start}, {start}
    while end not in frontier:
        frontier = {following for state in frontier for following in followers.get(state, ())} - seen
        seen |= frontier
        distance += 1
    return distance
