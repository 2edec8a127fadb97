"""How well a study's predictions fit its decisions: predicted quantiles of outcomes beside observed shares.

Users are a random sample of so many that a report takes seconds, with all that happened to them. Outcomes are
predicted by the belief before each, in the order in which they came. Of all outcomes, a share q should lie at or
below the predicted quantile of level q. The level of an outcome is P(U ≤ u) (probability integral transform, Dawid
1984). An outcome with probability of its own covers the levels from P(U < u) to P(U ≤ u), evenly (Czado, Gneiting
and Held 2009). Intervals are 95 %, by the spread between users: the predictions for one user hang together.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.beliefs import learn, learn_turn, start_at_priors, turns
from lifelore.agent.personalise.study import Study
from lifelore.core.intervals import welch_interval
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.memory import Memory
from lifelore.memory.study_rows import DecisionRow, UserRow

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

SAMPLE = 2000
"""Largest number of users in a sample; more cost time and make curves and calibration less noisy."""
LEVELS = tuple(level / 10 for level in range(1, 10))
"""Levels of the predicted quantiles that are compared."""
LEAST_USERS = 3
"""Users behind an interval, or it is left out."""


class History(NamedTuple):
    """A user.

    past : (policy, outcome) of the outcomes elsewhere
    decisions : those that count, in order of time
    """

    user: UserRow
    past: list[tuple[str, float]]
    decisions: list[DecisionRow]

    @property
    def ended(self) -> list[DecisionRow]:
        """The decisions with an outcome in the order in which outcomes came."""
        ended = (one for one in self.decisions if one.outcome is not None)
        return sorted(ended, key=lambda one: (one.ended, one.id))


def sampled_histories(
    memory: Memory, study: Study, people: NDArray[np.float64], *, since: int = 0
) -> list[History]:
    """At most `SAMPLE` of users, sorted by name; the same sample of the same users.

    Parameters
    ----------
    people : (n,) float64
        Numbers of users.
    since : int
        Decisions before this time are left out, in milliseconds.
    """
    people = np.sort(people)
    if len(people) > SAMPLE:
        people = np.sort(np.random.default_rng(0).choice(people, SAMPLE, replace=False))
    numbers = people.astype(np.int64).tolist()
    with memory.studies.reading(study.number) as rows:
        users, past, decisions = rows.numbered(numbers), rows.past_of(numbers), rows.decisions_of(numbers)
    found = [
        History(user, past.get(number, []), [one for one in decisions.get(number, []) if one.time >= since])
        for number, user in users.items()
    ]
    return sorted((one for one in found if one.decisions), key=lambda one: one.user.name)


def difference(first: NDArray[np.float64], second: NDArray[np.float64]) -> dict[str, Any] | None:
    """Difference of means of users with Welch's interval, if there are users and spread enough for one."""
    if not len(first) or not len(second):
        return None
    ci95 = welch_interval(first, second)  # pyright: ignore[reportArgumentType]
    value = float(np.mean(first) - np.mean(second))
    return {"value": value, "ci95": list(ci95) if ci95 else None, "n": [len(first), len(second)]}


def lived_again(study: Study, histories: Sequence[History]) -> tuple[ReuseAlgorithm, dict[str, Any] | None]:
    """The beliefs about users after their last outcomes, a row each, and the calibration of the outcomes.

    Returns
    -------
    algorithm : ReuseAlgorithm
    calibration : dict
        See `calibrated`; None without an outcome of a policy that the library knows.
    """
    algorithm, levels, users = study.algorithm.new_rows(len(histories)), [], []
    start_at_priors(algorithm, study, [one.user for one in histories])
    learn(algorithm, study, [(row, *pair) for row, one in enumerate(histories) for pair in one.past])
    outcomes = [(row, one.policy, one.outcome or 0.0) for row, own in enumerate(histories) for one in own.ended]
    for rows, policies, values in turns(study, outcomes):
        known = policies >= 0
        if known.any():
            levels.append(_levels(algorithm, rows[known], policies[known], values[known]))
            users.append(rows[known])
        learn_turn(algorithm, rows, policies, values)
    if not users:
        return algorithm, None
    return algorithm, calibrated(np.concatenate(levels), np.concatenate(users))


def _levels(algorithm: ReuseAlgorithm, rows: Numbers, policies: Numbers, values: Array) -> Array:
    """P(U < u) and P(U ≤ u) of an outcome of each user under the belief before it, (n, 2)."""
    belief, levels = algorithm.belief(rows), np.empty((len(rows), 2))
    for policy in np.unique(policies).tolist():
        at = policies == policy
        performance = algorithm.known(rows[at]).performance
        for end, own in enumerate((np.nextafter(values[at], -np.inf), values[at])):
            levels[at, end] = (belief[at].T * performance.cumulative(policy, own)).sum(axis=0)
    return np.clip(levels, 0.0, 1.0)


def calibrated(levels: Array, users: Numbers) -> dict[str, Any]:
    """Shares of outcomes at or below predicted quantiles.

    Parameters
    ----------
    levels : (n, 2) float64
        P(U < u) and P(U ≤ u) of each outcome, under the belief before it.
    users : (n,) int64
        The user of each outcome.

    Returns
    -------
    dict
        ``predicted``, the levels of quantiles; ``observed`` shares at or below them, with ``ci95`` (None with
        fewer than three users or without spread); ``n`` outcomes behind each, of ``groups`` users; ``error``, the
        mean distance of observed from predicted.
    """
    low, width = levels[:, 0], np.maximum(levels[:, 1] - levels[:, 0], 1e-12)
    shares = [_share(np.clip((level - low) / width, 0.0, 1.0), users) for level in LEVELS]
    return {
        "predicted": list(LEVELS),
        "observed": [share for share, _ in shares],
        "ci95": [interval for _, interval in shares],
        "n": [len(levels)] * len(LEVELS),
        "groups": len(np.unique(users)),
        "error": float(np.mean([abs(share - level) for level, (share, _) in zip(LEVELS, shares, strict=True)])),
    }


def _share(hits: Array, users: Numbers) -> tuple[float, list[float] | None]:
    """Mean of `hits` (n,) in [0, 1], and its interval by the spread between users (linearised ratio)."""
    share, (_, place) = float(hits.mean()), np.unique(users, return_inverse=True)
    residual = np.bincount(place, hits - share)
    n, spread = len(residual), float((residual**2).sum())
    if n < LEAST_USERS or spread <= 1e-18 * len(hits):
        return share, None
    half = 1.96 * (spread * n / (n - 1)) ** 0.5 / len(hits)
    return share, [max(share - half, 0.0), min(share + half, 1.0)]
