"""The law of steps: probabilities of a step's outcomes, known from a finite number of runs, Dirichlet.

Each (state, action) has a Dirichlet law, which a user's own steps change, also within an episode. The likelihood
of an episode is the product of the predictive probabilities of its steps in order (Dirichlet-multinomial).
Thesis: §4.4.2.1–2.
"""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.outcomes.law import Law, Numbers
from lifelore.interaction.outcomes.special_functions import gammaln
from lifelore.interaction.outcomes.spread import Spread

if TYPE_CHECKING:
    from lifelore.interaction.signals.step_model import StepModel

Array = NDArray[Any]


class StepLaw(Law):
    """P(outcomes | states and actions; type, policy) given the steps that each user has shown.

    Parameters
    ----------
    signal : StepModel
        The library's, from counted steps; not changed.
    """

    single = False

    def __init__(self, signal: "StepModel") -> None:
        assert signal.totals is not None
        self.signal, self.n_types, self.spread = signal, signal.n_types, Spread.known(0.0)
        self.shape = (*signal.log_table.shape[:3], signal.shape[2])  # counts of steps

    def log_likelihoods(
        self, policies: Numbers, signals: Any, shown: Array | None = None, users: Numbers = None
    ) -> Array:
        """Log likelihoods of episodes (...) given what `users` (...) have shown, (..., 1, n_types)."""
        if np.ndim(policies) == 0:
            return self._of_one(policies, signals, None if shown is None else shown[users])[None]
        counts = [None] * len(policies) if shown is None else list(shown[users])
        found = [self._of_one(*each) for each in zip(policies.tolist(), signals, counts, strict=True)]
        return np.array(found)[:, None]

    def learn(self, shown: Array, users: Numbers, policies: Numbers, signals: Any) -> None:
        """Add episodes of distinct users."""
        if np.ndim(policies) == 0:
            policies, signals, users = np.array([policies]), [signals], [users]
        for user, policy, signal in zip(users, policies, signals, strict=True):
            np.add.at(shown[user], self.signal.places_of(policy, signal), 1.0)

    def _of_one(self, policy: int, signal: Any, counts: Array | None) -> Array:
        *places, outcomes = self.signal.places_of(policy, signal)
        rows, of_row = np.unique(np.stack(places), axis=1, return_inverse=True)
        at = tuple(rows)
        new = np.zeros((rows.shape[1], self.signal.shape[2]))
        np.add.at(new, (of_row.ravel(), outcomes), 1.0)
        assert self.signal.totals is not None
        # (m, n_outcomes, n_types)
        prior = np.exp(self.signal.log_table[at]) * self.signal.totals[at][:, None]
        if counts is not None:
            prior = prior + counts[at][:, :, None]
        total, possible = prior.sum(axis=1), prior > 0
        safe, came = np.where(possible, prior, 1.0), new[:, :, None]
        gained = np.where(possible, gammaln(safe + came) - gammaln(safe), np.where(came > 0, -np.inf, 0.0))
        lost = gammaln(total + new.sum(axis=1)[:, None]) - gammaln(total)
        return gained.sum(axis=(0, 1)) - lost.sum(axis=0)
