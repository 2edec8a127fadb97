"""How well libraries serve users of a log who were held out: log scores, and the values of the policies chosen.

A held-out user starts as a stranger of the user's context, and the library is asked twice: before the first
outcome, and when half of the user's outcomes were shown to it. Each time it chooses one of the policies that the
outcomes which were not shown are of. The value of the choice is the user's mean outcome of that policy among them.
The second time it also gives a probability to each of these outcomes. They are scored in bins that all models
share, so that categories and amounts compare.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.evaluation.propensity_weights import decision_numbers
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.prediction import Prediction
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

MOST_SHOWN = 20
"""Largest number of a user's outcomes that are used; more cost time."""
BINS = 8
"""Largest number of bins of outcomes in log scores."""
LEAST = 1e-4
"""Least probability of a bin: a single impossible outcome does not decide."""
COUNTED = 2.0
"""Outcomes that a policy's mean counts as where a user's own outcomes are counted."""


class Scores(NamedTuple):
    """Of each held-out user, (n_users,).

    log_score : mean log probability of a later outcome's bin; 0 where the library knows none of the policies
    value : mean outcome of the policy chosen, mean of both times; NaN where there was only one policy
    """

    log_score: Array
    value: Array


class HeldOut:
    """Users of a log, and of each the first `MOST_SHOWN` outcomes in turn.

    Parameters
    ----------
    log : ReuseLog
        Every user has at least two rows.

    Attributes
    ----------
    policies : (n_users, MOST_SHOWN) int64
        −1 where there is none.
    outcomes : (n_users, MOST_SHOWN) float64
    half : (n_users,) int64
        Number of outcomes that are shown.
    later : (n_users, MOST_SHOWN) bool
        The other outcomes.
    """

    def __init__(self, log: ReuseLog) -> None:
        self.log, user, turn = log, log.user.codes, decision_numbers(log.user.codes)
        rows, shape = turn < MOST_SHOWN, (len(log.user.names), MOST_SHOWN)
        self.policies, self.outcomes = np.full(shape, -1), np.zeros(shape)
        at = user[rows], turn[rows]
        self.policies[at], self.outcomes[at] = log.policy.codes[rows], log.outcomes[rows]
        self.half = np.minimum(np.bincount(user), MOST_SHOWN) // 2
        self.later = (self.policies >= 0) & (np.arange(MOST_SHOWN) >= self.half[:, None])
        ends = np.unique(log.outcomes)
        # Outcomes may all be equal, as are rare clicks in a part of the users: then there is a single bin.
        cuts = np.append(0.5 * (ends[:-1] + ends[1:]), np.inf)
        some = np.searchsorted(ends, np.quantile(log.outcomes, np.arange(1, BINS) / BINS))
        self.cuts = np.unique([-np.inf, *cuts[np.minimum(some, max(len(ends) - 2, 0))], np.inf])

    def of_library(self, library: PolicyLibrary, contexts: Mapping[str, Array] | None = None) -> Scores:
        """The scores of a library; policies that it does not know are neither scored nor chosen.

        Parameters
        ----------
        contexts : mapping of str to (n_types,) float, optional
            Prior over types of users of a context; the library's for others.
        """
        numbers = {policy: number for number, policy in enumerate(library.policies)}
        place = np.array([numbers.get(policy, -1) for policy in self.log.policy.names] + [-1])
        static = TypeDynamics.static()
        algorithm = ReuseAlgorithm(library, len(self.policies), dynamics=static, unknown=None)
        priors = [(contexts or {}).get(name, library.prior) for name in (*self.log.context.names, "")]
        # Without a context the place is -1, the last row.
        algorithm.log_belief[:] = np.stack([algorithm.start(prior) for prior in priors])[self.log.context_of_user]
        every = np.arange(len(self.policies))
        start = self._expected(algorithm.known(every).performance, algorithm.belief(every), place)
        for turn, policies in enumerate(place[self.policies].T):
            users = np.flatnonzero((turn < self.half) & (policies >= 0))
            if users.size:
                algorithm.update(users, policies[users], self.outcomes[users, turn])
        performance, belief = algorithm.known(every).performance, algorithm.belief(every)
        value = self._values(start, self._expected(performance, belief, place))
        return Scores(self._log_score(performance, belief, place[self.policies]), value)

    @staticmethod
    def _expected(performance: Prediction, belief: Array, place: NDArray[np.int64]) -> Array:
        """Expected outcomes of the log's policies, (n_users, n_policies); minus infinity without a place."""
        known = place[:-1] >= 0
        expected = np.full((len(belief), len(known)), -np.inf)
        expected[:, known] = performance.expected(belief)[:, place[:-1][known]]
        return expected

    def by_means(self, means: Array, counted: float = np.inf) -> Array:
        """Values of choosing by policies' `means` that count as `counted` outcomes beside a user's own."""
        n, shown = len(self.log.policy.names), np.arange(MOST_SHOWN) < self.half[:, None]
        place = (np.arange(len(self.policies))[:, None] * n + self.policies)[shown]
        number = np.bincount(place, minlength=len(self.policies) * n).reshape(-1, n)
        total = np.bincount(place, self.outcomes[shown], minlength=len(self.policies) * n).reshape(-1, n)
        own = total / np.maximum(number, 1) - means
        return self._values(np.tile(means, (len(number), 1)), means + number / (number + counted) * own)

    def _values(self, start: Array, half: Array) -> Array:
        """Mean of the values of both times, by expected outcomes (n_users, n_policies) at each."""
        both = np.stack([self.value(start, self.policies >= 0), self.value(half, self.later)])
        number = (~np.isnan(both)).sum(axis=0)
        return np.where(number > 0, np.nansum(both, axis=0) / np.maximum(number, 1), np.nan)

    def value(self, expected: Array, scored: Bools) -> Array:
        """Mean outcome of the best of the policies of `scored` outcomes, by `expected` (n_users, n_policies)."""
        rows, _ = np.nonzero(scored)
        offered = np.full(expected.shape, -np.inf)
        offered[rows, self.policies[scored]] = expected[rows, self.policies[scored]]
        chosen = scored & (self.policies == offered.argmax(axis=1)[:, None])
        several = np.isfinite(offered).sum(axis=1) > 1
        found = (self.outcomes * chosen).sum(axis=1) / np.maximum(chosen.sum(axis=1), 1)
        return np.where(several, found, np.nan)

    def _log_score(self, performance: Prediction, belief: Array, own: NDArray[np.int64]) -> Array:
        scored, bins = self.later & (own >= 0), np.searchsorted(self.cuts, self.outcomes)
        probs = np.zeros(own.shape)
        for number, cut in enumerate(self.cuts):
            # P(outcome > cut) ends the bin below the cut, and begins the one above.
            above = np.take_along_axis(performance.exceedance(cut), np.maximum(own, 0)[:, None], axis=2)
            above = (belief[..., None] * above).sum(axis=1)
            probs += np.where(bins == number + 1, above, 0.0) - np.where(bins == number, above, 0.0)
        logs = np.where(scored, np.log(np.maximum(probs, LEAST)), 0.0)
        return logs.sum(axis=1) / np.maximum(scored.sum(axis=1), 1)
