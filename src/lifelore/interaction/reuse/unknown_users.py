"""Users whom no known type fits: what they have shown of an unknown type, the odds of it, and what to try on them.

    log odds ← log odds + log q(σ) − log m(σ)

q is a type as broad as all types of the library together (`unknown_law`), m the mixture of the known types, each
given the user's earlier signals. The unknown type never changes, so what a user has shown of it never fades: only
evidence leads to it or away from it. Known types may change (`beliefs`), and what was shown of them then fades.

Each policy may well have the mean pay m + 2 s on this user, with mean m and deviation s of the policy's mean pay
in the unknown type. These bounds are the scores where the odds exceed 1, or where policies could gain enough:

    P(unknown type) (max_π (m + 2 s) − Σ β(τ) max_π E[U | τ, π]) > 0.25 deviations of mean pays in the unknown type

So policies are also tried on users who fit a known type by the few policies that were tried, where that type pays
little. A policy is tried until it is probably worse.
"""

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.law import Law, Numbers
from lifelore.interaction.reuse.explanation import MAX_SURPRISE
from lifelore.interaction.reuse.user_model import UserModel

Array = NDArray[Any]

MASS = 0.15
"""Prior probability of the unknown type; more finds such users sooner, and takes more known users for such."""
FIRST = float(np.log(MASS / (1 - MASS)))
"""Log odds of the unknown type of a user who has shown nothing."""
DEVIATIONS = 2.0
"""Deviations of a mean pay that count in favour of a policy; more tries policies longer."""
GAIN = 0.25
"""Least possible gain for trying policies, in deviations of a mean pay; less tries more, also on known users."""


class UnknownUsers(UserModel):
    """What users have shown of the unknown type, and the odds that they are of it.

    Parameters
    ----------
    law : Law
        Of the unknown type, see `unknown_law`. Policies are tried where it is that of numbers.
    n_users : int

    Attributes
    ----------
    log_odds : (n_users,) float64
        Log of P(unknown type) / P(any known type), given what the user has shown.
    """

    def __init__(self, law: Law, n_users: int) -> None:
        super().__init__(law, n_users)
        self.log_odds: Array = np.full(n_users, FIRST)

    def weigh(self, users: Numbers, policies: Numbers, signals: Any, log_evidence: Array) -> None:
        """Take in signals of distinct users; `log_evidence` (...) is log m(σ).

        A signal counts at most `MAX_SURPRISE` nats against either side.
        """
        signals = self.law.checked(signals)
        broad = self.law.log_likelihoods(policies, signals, self.shown, users)[..., 0, 0]
        self.log_odds[users] += np.maximum(broad, -MAX_SURPRISE) - np.maximum(log_evidence, -MAX_SURPRISE)
        self.law.learn(self.shown, users, policies, signals)

    @cached_property
    def _least(self) -> float:
        law: Any = self.law
        return GAIN * float(np.sqrt(law.of_runs.mean()))

    def bounds(self, users: Numbers) -> Array:
        """m + 2 s of each policy's mean pay on `users` (...), (..., n_policies)."""
        law: Any = self.law
        mean, variance = law.mean_pays(self.shown, users)
        return mean + DEVIATIONS * np.sqrt(variance)

    def tried(self, users: Numbers, bounds: Array, known: Array) -> Any:
        """Whether policies are tried on `users` (...), (...) bool.

        Parameters
        ----------
        bounds : (..., n_policies)
            Minus infinity where a policy is not available.
        known : (...)
            Expected mean pay of the policy that is best for the user's type, of the known types.
        """
        gain = self.probability(users) * (bounds.max(axis=-1) - known)
        return (self.log_odds[users] > 0) | (gain > self._least)

    def probability(self, users: Numbers) -> Array:
        """P(unknown type) of `users` (...), (...)."""
        return np.exp(-np.logaddexp(0.0, -self.log_odds[users]))

    def fade(self, users: Numbers, keep: Array) -> None:
        """Nothing: the unknown type does not change."""

    def reset(self, users: Numbers) -> None:
        """Forget what `users` have shown."""
        super().reset(users)
        self.log_odds[users] = FIRST

    def grow(self, n_users: int) -> None:
        """Make room for `n_users` users; new users have shown nothing."""
        super().grow(n_users)
        self.log_odds = np.append(self.log_odds, np.full(n_users - len(self.log_odds), FIRST))

    def arrays(self) -> list[Array]:
        """Every array with a row for each user."""
        return [*super().arrays(), self.log_odds]

    def state(self, user: int) -> dict[str, Array]:
        """What a single user has shown, as small arrays."""
        return super().state(user) | {"log_odds": self.log_odds[user].copy()}

    def restore(self, user: int, state: Mapping[str, ArrayLike]) -> None:
        """Take over a `state`; InputError where it is of another library.

        An empty state is of a session from before there was an unknown type: that user stays with the known types.
        """
        if not state:
            self.shown[user], self.log_odds[user] = 0, -np.inf
            return
        super().restore(user, state)
        log_odds = np.asarray(state.get("log_odds"), np.float64)
        if log_odds.shape != () or not log_odds < np.inf:
            raise InputError("a user's state must have the log odds of the unknown type, a number below infinity")
        self.log_odds[user] = log_odds
