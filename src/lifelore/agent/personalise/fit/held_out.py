"""How well libraries serve users of a log who were held out: log scores, and the value of the policy chosen.

A held-out user's first outcomes are shown to the library. It then gives a probability to each later outcome, and
chooses one of the policies that these outcomes are of. The value is the user's mean later outcome of that policy.
Outcomes are scored in bins that all models share, so that categories and amounts compare.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.evaluate.replayed_choices import turns
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm

Array = NDArray[np.float64]

MOST_SHOWN = 10
"""Largest number of a user's outcomes that are shown, and that are scored; more cost time."""
BINS = 8
"""Largest number of bins of outcomes in log scores."""
LEAST = 1e-4
"""Least probability of a bin: a single impossible outcome does not decide."""
COUNTED = 2.0
"""Outcomes that a policy's mean counts as where a user's own outcomes are counted."""


class Scores(NamedTuple):
    """Of each held-out user, (n_users,).

    log_score : mean log probability of a later outcome's bin
    value : mean later outcome of the policy chosen; NaN where the later outcomes are of a single policy
    """

    log_score: Array
    value: Array


class HeldOut:
    """Users of a log, of each the first half of the outcomes to show, and the others to score.

    Parameters
    ----------
    log : ReuseLog
        Every user has at least two rows.
    """

    def __init__(self, log: ReuseLog) -> None:
        self.log, user, turn = log, log.user.codes, turns(log.user.codes)
        n_shown = np.minimum(np.bincount(user) // 2, MOST_SHOWN)
        self.shown = self._table(turn < n_shown[user], turn)
        scored = (turn >= n_shown[user]) & (turn < n_shown[user] + MOST_SHOWN)
        self.scored = self._table(scored, turn - n_shown[user])
        ends = np.unique(log.outcomes)
        cuts = 0.5 * (ends[:-1] + ends[1:])
        some = np.searchsorted(ends, np.quantile(log.outcomes, np.arange(1, BINS) / BINS))
        self.cuts = np.concatenate([[-np.inf], np.unique(cuts[np.minimum(some, len(cuts) - 1)]), [np.inf]])

    def _table(self, rows: NDArray[np.bool_], place: NDArray[np.int64]) -> tuple[NDArray[np.int64], Array]:
        """Policies, −1 where there is none, and outcomes of some rows, (n_users, n) each."""
        shape = len(self.log.user.names), MOST_SHOWN
        policies, outcomes = np.full(shape, -1), np.zeros(shape)
        at = self.log.user.codes[rows], place[rows]
        policies[at], outcomes[at] = self.log.policy.codes[rows], self.log.outcomes[rows]
        return policies, outcomes

    def of_library(self, library: PolicyLibrary) -> Scores:
        """The scores of a library; policies that it does not know are neither scored nor chosen."""
        numbers = {policy: number for number, policy in enumerate(library.policies)}
        place = np.array([numbers.get(policy, -1) for policy in self.log.policy.names] + [-1])
        algorithm = ReuseAlgorithm(library, len(self.log.user.names), dynamics=TypeDynamics.static())
        for policies, outcomes in zip(place[self.shown[0]].T, self.shown[1].T, strict=True):
            if (users := np.flatnonzero(policies >= 0)).size:
                algorithm.update(users, policies[users], outcomes[users])
        every = np.arange(algorithm.n_users)
        performance, belief = algorithm.known(every).performance, algorithm.belief(every)
        expected = performance.expected(belief)
        by_log = np.full((len(every), len(self.log.policy.names)), -np.inf)
        by_log[:, place[:-1] >= 0] = expected[:, place[:-1][place[:-1] >= 0]]
        return Scores(self._log_score(performance, belief, place[self.scored[0]]), self.value(by_log))

    def by_means(self, means: Array, counted: float = np.inf) -> Array:
        """Values of choosing by policies' `means` that count as `counted` outcomes beside a user's own."""
        policies, outcomes = self.shown
        n = len(self.log.policy.names)
        known = policies >= 0
        place = (np.arange(len(policies))[:, None] * n + policies)[known]
        number = np.bincount(place, minlength=len(policies) * n).reshape(-1, n)
        total = np.bincount(place, outcomes[known], minlength=len(policies) * n).reshape(-1, n)
        own = total / np.maximum(number, 1) - means
        return self.value(means + number / (number + counted) * own)

    def value(self, expected: Array) -> Array:
        """Mean later outcome of the best of the later policies by `expected` (n_users, n_policies)."""
        policies, outcomes = self.scored
        users, known = np.arange(len(policies)), policies >= 0
        offered = np.full(expected.shape, -np.inf)
        rows = np.broadcast_to(users[:, None], policies.shape)[known]
        offered[rows, policies[known]] = expected[rows, policies[known]]
        chosen = policies == offered.argmax(axis=1)[:, None]
        several = np.isfinite(offered).sum(axis=1) > 1
        found = (outcomes * chosen).sum(axis=1) / np.maximum(chosen.sum(axis=1), 1)
        return np.where(several, found, np.nan)

    def _log_score(self, performance: Any, belief: Array, policies: NDArray[np.int64]) -> Array:
        users, total, number = np.arange(len(belief)), np.zeros(len(belief)), np.zeros(len(belief))
        for own, outcomes in zip(policies.T, self.scored[1].T, strict=True):
            above = np.searchsorted(self.cuts, outcomes).clip(1, len(self.cuts) - 1)
            ends = [performance.exceedance(self.cuts[end])[users, :, own] for end in (above - 1, above)]
            probs = np.maximum((belief * (ends[0] - ends[1])).sum(axis=1), LEAST)
            total, number = total + np.where(own >= 0, np.log(probs), 0.0), number + (own >= 0)
        return total / np.maximum(number, 1)
