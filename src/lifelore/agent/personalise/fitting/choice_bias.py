"""Whether the choices of a log suited the users, so that the policies' mean outcomes are biased.

A policy's mean is biased where users with good outcomes of it get it more, or less, often than others. Before each
line of a user who had the policy before, let x be the mean of these outcomes less the policy's mean, and c whether
the line chose it again. Choices that do not depend on the user give

    z = Σ_u s_u / √(Σ_u s_u²),    s_u = Σ_lines (x − mean x) (c − mean c)

a normal distribution, also where users leave after bad outcomes, and where each user has own shares of policies.
Means are those of the users' lines of the same number, since shares and outcomes may both change in time.
All policies together are a comparison too, the clearest one where each is chosen a little too often.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.log.log import ReuseLog

Array = NDArray[np.float64]

CHANCE = 1e-3
"""Probability of a warning where choices do not depend on the user."""
LEAST_DIFFERENCE = 0.05
"""Difference of shares of lines below which a dependence does not matter."""


class ChoiceBias(NamedTuple):
    """How often a policy came again after outcomes of it above its mean, and else.

    policy : None: any
    share, others : of lines
    z : of their difference
    """

    policy: str | None
    share: float
    others: float
    z: float


def choice_bias(log: ReuseLog) -> ChoiceBias | None:
    """The largest clear dependence of a choice on the user; None where there is none, or lines have weights.

    Parameters
    ----------
    log : ReuseLog
        A user's lines in order of time. Where it names types, outcomes are compared within them.
    """
    if log.weights is not None:
        return None
    order, names = np.argsort(log.user.codes, kind="stable"), log.policy.names
    users, codes, outcomes = log.user.codes[order], log.policy.codes[order], log.outcomes[order]
    pair = (log.type_of_user[users] + 1) * len(names) + codes
    number = np.arange(len(users)) - np.searchsorted(users, users)
    gain = outcomes - (np.bincount(pair, outcomes) / np.maximum(np.bincount(pair), 1))[pair]
    parts, found = [], []
    for place, policy in enumerate(names):
        who = np.zeros(len(log.user.names), np.bool_)
        who[users[codes == place]] = True
        rows = np.flatnonzero(who[users])  # of many policies, a user has few
        x = _mean_before(users[rows], codes[rows] == place, gain[rows])
        rows, x = rows[~np.isnan(x)], x[~np.isnan(x)]
        if len(rows):
            x, share = x - _means(number[rows], x), _means(number[rows], codes[rows] == place)
            chosen = codes[rows] == place
            parts.append((users[rows], x / (x.std() or 1.0), chosen - share, share))
            found.append(_compared(policy, *parts[-1]))
    if parts:
        found.append(_compared(None, *(np.concatenate(column) for column in zip(*parts, strict=True))))
    from scipy.stats import norm

    least = norm.isf(CHANCE / 2 / max(1, len(found)))
    clear = [one for one in found if abs(one.z) > least and abs(one.share - one.others) > LEAST_DIFFERENCE]
    return max(clear, key=lambda one: abs(one.share - one.others), default=None)


def _mean_before(users: NDArray[np.int64], chosen: NDArray[np.bool_], gain: Array) -> Array:
    """Mean gain of each user's chosen lines before each line, NaN before the first; users' lines are together."""
    number, total = np.cumsum(chosen) - chosen, np.cumsum(chosen * gain) - chosen * gain
    first = np.searchsorted(users, users)
    number, total = number - number[first], total - total[first]
    return np.where(number > 0, total / np.maximum(number, 1), np.nan)


def _means(groups: NDArray[np.int64], values: NDArray[Any]) -> Array:
    """(n,) mean of the values of each one's group."""
    return (np.bincount(groups, values) / np.maximum(np.bincount(groups), 1))[groups]


def _compared(policy: str | None, users: NDArray[np.int64], x: Array, chosen: Array, share: Array) -> ChoiceBias:
    """The comparison of lines with x above 0 and others; x and `chosen` have mean 0, as `share` was taken off."""
    high, score = x > 0, np.bincount(users, x * chosen)
    if not high.any() or not score.any():
        return ChoiceBias(policy, 0.0, 0.0, 0.0)
    more, less = (float(share.mean() + chosen[side].mean()) for side in (high, ~high))
    return ChoiceBias(policy, more, less, float(score.sum() / np.sqrt((score**2).sum())))
