"""A law and what users have shown of it; Bayes' rule for the spreads of a law beside the belief over types.

    F(σ | τ, π) = (1 − w_τ) F(σ | τ, π, all signals so far) + w_τ F(σ | τ, π)

w_τ is the probability that a user who is now of type τ has just changed to it; 0 where types do not change. The
signals so far count less afterwards by the probability that the type has just changed. Where a single change lies
between many signals this is close to exact; it is not exact, since the signals of both types are summed up.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.law import Law, Numbers, of_users

Array = NDArray[Any]

SLACK = 1e-5
"""Rounding error of probabilities that sum to 1."""


class Evidence(NamedTuple):
    """What signals say of the types, and of what users have shown.

    log_likelihood : (..., n_types), log F
    changed : (..., n_types) or None
        Probability that the type has just changed, given that it is now this type and showed the signal; None
        where types do not change.
    gain : (..., n_spreads) or None
        Log likelihoods of the spreads, up to a constant; None where there is a single spread.
    """

    log_likelihood: Array
    changed: Array | None
    gain: Array | None


class UserModel:
    """What users have shown of a law.

    Parameters
    ----------
    law : Law
    n_users : int

    Attributes
    ----------
    shown : (n_users, ...), the statistics of `law`
    log_weights : (n_users, n_spreads) float64
        Log probabilities of the spreads, given what the user has shown.
    """

    def __init__(self, law: Law, n_users: int) -> None:
        self.law, self.shown = law, law.shown(n_users)
        self._log_first: Array = np.log(law.spread.weights)
        self.log_weights: Array = np.tile(self._log_first, (n_users, 1))

    def evidence(
        self, users: Numbers, policies: Numbers, signals: Any, log_belief: Array, changed: Array | None
    ) -> Evidence:
        """The evidence of checked signals (...) of `users` (...) under a law that learns, before they are learnt.

        Parameters
        ----------
        log_belief : (..., n_types)
            Before the signals.
        changed : (..., n_types), optional
            w, as `TypeDynamics.changed_share` gives it.
        """
        law = self.law
        found = law.log_likelihoods(policies, signals, self.shown, users)
        if found.shape[-2] == 1:
            stayed, gain = found, None
        else:
            gain = np.logaddexp.reduce(found + log_belief[..., None, :], axis=-1)
            stayed = found + of_users(self.log_weights, users)[..., None].astype(found.dtype, copy=False)
        stayed = _over_spreads(stayed)
        if changed is None:
            return Evidence(stayed, None, gain)
        first = law.log_likelihoods(policies, signals) + self._log_first[:, None].astype(found.dtype, copy=False)
        with np.errstate(divide="ignore", invalid="ignore"):
            anew = _over_spreads(first) + np.log(changed)
            whole = np.logaddexp(np.log1p(-changed) + stayed, anew)
            # Not a number where neither explains the signal.
            return Evidence(whole, np.fmax(np.exp(anew - whole), 0.0), gain)

    def prediction(self, users: Numbers) -> Any:
        """What rules read of the next outcome or signal of `users`, see `Law`."""
        law: Any = self.law
        return law.prediction(self.shown, users, self.log_weights[users])

    def fade(self, users: Numbers, keep: Array) -> None:
        """Let all that distinct `users` have shown count `keep` (...) of what it did: types may have changed."""
        if not self.law.learns:
            return
        self.law.fade(self.shown, users, keep)
        if self._log_first.size == 1:
            return
        share = np.asarray(keep)[..., None]
        with np.errstate(divide="ignore"):
            weights = share * np.exp(self.log_weights[users]) + (1 - share) * self.law.spread.weights
            self.log_weights[users] = np.log(weights)

    def learn(self, users: Numbers, policies: Numbers, signals: Any, gain: Array | None) -> None:
        """Take in signals of distinct users; `gain` as in their `Evidence`."""
        if gain is not None:
            found = self.log_weights[users] + gain
            total = np.logaddexp.reduce(found, axis=-1, keepdims=True)
            self.log_weights[users] = np.where(total > -np.inf, found - total, self.log_weights[users])
        self.law.learn(self.shown, users, policies, signals)

    def reset(self, users: Numbers) -> None:
        """Forget what `users` have shown."""
        self.shown[users] = 0
        self.log_weights[users] = self._log_first

    def grow(self, n_users: int) -> None:
        """Make room for `n_users` users; new users have shown nothing."""
        more = n_users - len(self.log_weights)
        self.shown = np.concatenate([self.shown, self.law.shown(more)])
        self.log_weights = np.concatenate([self.log_weights, np.tile(self._log_first, (more, 1))])

    def arrays(self) -> list[Array]:
        """Every array with a row for each user."""
        return [self.shown, self.log_weights]

    def state(self, user: int) -> dict[str, Array]:
        """What a single user has shown, as small arrays; empty where nothing is learnt."""
        if not self.law.learns:
            return {}
        return {**self.law.state(self.shown, user), "log_weights": self.log_weights[user].copy()}

    def restore(self, user: int, state: Mapping[str, ArrayLike]) -> None:
        """Take over a `state`; InputError where it is of another library."""
        try:
            log_weights = np.array(state.get("log_weights", self._log_first), np.float64)
            if log_weights.shape != self._log_first.shape or not abs(np.exp(log_weights).sum() - 1) < SLACK:
                raise InputError(f"a user's state must have {len(self._log_first)} probabilities of spreads")
            if self.law.learns:
                self.law.restore(self.shown, user, state)  # pyright: ignore[reportArgumentType]
        except (KeyError, IndexError, ValueError, TypeError) as error:
            raise InputError(f"the user's state is not of this library: {error}") from None
        self.log_weights[user] = log_weights


def _over_spreads(terms: Array) -> Array:
    """log Σ exp over the spreads, (..., n_spreads, n_types) to (..., n_types)."""
    return terms[..., 0, :] if terms.shape[-2] == 1 else np.logaddexp.reduce(terms, axis=-2)
