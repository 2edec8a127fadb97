"""Whether the choices of a log suited the users, so that the policies' mean outcomes are biased.

A policy's mean is biased where users with good outcomes of it get it more, or less, often than others. Before each
line of a user who had the policy before, let x be the mean of these outcomes less the policy's mean, and c whether
the line chose it again. Choices that do not depend on the user give

    z = Σ_u s_u / √(Σ_u s_u²),    s_u = Σ_lines (x − mean x) (c − mean c)

a normal distribution, also where users leave after bad outcomes, and where each user has own shares of policies.
All policies together are a comparison too, the clearest one where each is chosen a little too often. Contexts are
compared in the same way, with x = 1 for the users of one.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.log.log import ReuseLog

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

CHANCE = 1e-3
"""Probability of a warning where choices do not depend on the user."""
LEAST_DIFFERENCE = 0.05
"""Difference of shares of lines below which a dependence does not matter."""


class ChoiceBias(NamedTuple):
    """A choice that depends on the user.

    policy : that is chosen; None: all policies together
    context : the one whose users differ from the others; None: users differ by their outcomes of the policy
    share, others : of lines that chose the policy, among users of the context or with better outcomes, and others
    """

    policy: str | None
    context: str | None
    share: float
    others: float


def choice_bias(log: ReuseLog, *, contexts: bool = True) -> ChoiceBias | None:
    """The largest clear dependence of a choice on the user; None where there is none, or lines have weights.

    Parameters
    ----------
    log : ReuseLog
        A user's lines in order of time. Where it names types, outcomes are compared within them.
    contexts : bool
        Whether to look at contexts too.
    """
    if log.weights is not None:
        return None
    users, codes, names = log.user.codes, log.policy.codes, log.policy.names
    pair = (log.type_of_user[users] + 1) * len(names) + codes
    gain = log.outcomes - (np.bincount(pair, log.outcomes) / np.maximum(np.bincount(pair), 1))[pair]
    order = np.argsort(users, kind="stable")
    of_context = log.context_of_user[users]
    again, found = [], []
    for place, policy in enumerate(names):
        chosen = codes[order] == place
        x = _mean_before(users[order], chosen, gain[order])
        later = ~np.isnan(x)
        if later.any():
            again.append(_Lines.of(users[order][later], x[later], chosen[later]))
            found.append(again[-1].compared(policy))
        for context in np.unique(of_context[of_context >= 0]).tolist() if contexts else ():
            lines = _Lines.of(users, (of_context == context).astype(np.float64), codes == place)
            found.append(lines.compared(policy, log.context.names[context]))
    if again:
        found.append(_Lines(*(np.concatenate(column) for column in zip(*again, strict=True))).compared(None))
    from scipy.stats import norm

    least = norm.isf(CHANCE / 2 / max(1, len(found)))
    clear = [bias for bias, z in found if abs(z) > least and abs(bias.share - bias.others) > LEAST_DIFFERENCE]
    return max(clear, key=lambda one: abs(one.share - one.others), default=None)


class _Lines(NamedTuple):
    """Lines to compare, (n,) each.

    x : of the user before the line, with mean 0 and deviation 1
    chosen : 1 or 0, less its mean
    share : that mean
    """

    users: Ints
    x: Array
    chosen: Array
    share: Array

    @classmethod
    def of(cls, users: Ints, x: Array, chosen: NDArray[np.bool_]) -> "_Lines":
        share = chosen.mean()
        return cls(users, (x - x.mean()) / (x.std() or 1.0), chosen - share, np.full(len(x), share))

    def compared(self, policy: str | None, context: str | None = None) -> tuple[ChoiceBias, float]:
        """The shares of lines of either sign of x, and z of their difference."""
        high, score = self.x > 0, np.bincount(self.users, self.x * self.chosen)
        if not high.any() or not score.any():
            return ChoiceBias(policy, context, 0.0, 0.0), 0.0
        share = self.share.mean()
        shares = (float(share + self.chosen[side].mean()) for side in (high, ~high))
        return ChoiceBias(policy, context, *shares), float(score.sum() / np.sqrt((score**2).sum()))


def _mean_before(users: Ints, chosen: NDArray[np.bool_], gain: Array) -> Array:
    """Mean gain of each user's chosen lines before each line, NaN before the first; users' lines are together."""
    number, total = np.cumsum(chosen) - chosen, np.cumsum(chosen * gain) - chosen * gain
    first = np.searchsorted(users, users)
    number, total = number - number[first], total - total[first]
    return np.where(number > 0, total / np.maximum(number, 1), np.nan)
