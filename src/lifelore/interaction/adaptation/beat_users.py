"""BEAT for many users at once: a row of log beliefs for each user, and tables in place of models. See `beat`."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.belief import log_prior, update

Array = NDArray[np.float64]


class BeatUsers:
    """As `Beat`, with signals given as numbers of a finite alphabet.

    Parameters
    ----------
    value : (n_types, n_policies) float
        Expected utility of each action set for each type.
    log_table : (n_policies, n_signals, n_types) float
        Log likelihood of each signal under each action set.
    n_users : int
    prior : (n_types,) or (n_users, n_types) float, optional
        Uniform by default.
    seed : int or numpy generator

    Attributes
    ----------
    log_belief : (n_users, n_types) float64
        Normalised logs.

    Raises
    ------
    InputError
        The table does not fit the values or holds NaN or infinity, a value is not finite, or the prior is no
        distribution.

    Thesis: §4.8.4, Alg. 9.
    """

    def __init__(
        self,
        value: ArrayLike,
        log_table: ArrayLike,
        n_users: int,
        *,
        prior: ArrayLike | None = None,
        seed: int | np.random.Generator = 0,
    ) -> None:
        self.value = np.asarray(value, np.float64)
        self.log_table = np.asarray(log_table, np.float64)
        if self.value.ndim != 2 or not self.value.size or not np.isfinite(self.value).all():
            raise InputError(f"value must be (n_types, n_policies) finite numbers, got {self.value.shape}")
        n_types, n_policies = self.value.shape
        if self.log_table.ndim != 3 or self.log_table.shape[::2] != (n_policies, n_types):
            raise InputError(
                f"log_table must be ({n_policies}, n_signals, {n_types}) to fit value, got {self.log_table.shape}"
            )
        if not (self.log_table < np.inf).all():
            raise InputError("log_table must be below infinity and no NaN; minus infinity is allowed")
        start = log_prior(np.full(n_types, 1 / n_types) if prior is None else prior)
        if start.shape not in ((n_types,), (n_users, n_types)):
            raise InputError(f"prior must be ({n_types},) or ({n_users}, {n_types}), got {start.shape}")
        self.log_belief: Array = np.array(np.broadcast_to(start, (n_users, n_types)))
        self._generator = np.random.default_rng(seed)

    def select(self, users: NDArray[np.int64], epsilon: ArrayLike = 0.0) -> NDArray[np.int64]:
        """The next action set of `users` (n,): with probability `epsilon` any, else the first of the best."""
        chosen = (np.exp(self.log_belief[users]) @ self.value).argmax(axis=1)
        epsilon = np.broadcast_to(np.asarray(epsilon, np.float64), chosen.shape)
        if not epsilon.any():
            return chosen
        explores = self._generator.random(len(chosen)) < epsilon
        return np.where(explores, self._generator.integers(self.value.shape[1], size=len(chosen)), chosen)

    def update(
        self,
        users: NDArray[np.int64],
        policies: NDArray[np.int64],
        signals: NDArray[np.int64],
        extra: Array | None = None,
    ) -> None:
        """Learn from a signal of each of `users` under `policies`.

        Parameters
        ----------
        users : (n,) int
            Distinct.
        policies, signals : (n,) int
        extra : (n, n_types) float, optional
            Log of a second factor of the likelihood.

        Raises
        ------
        InputError
            A user comes twice, or `extra` holds NaN or infinity; no belief has changed then.
        """
        if len(np.unique(users)) < len(users):
            raise InputError("users must be distinct; update a user that comes twice in two calls")
        likelihood = self.log_table[policies, signals]
        if extra is not None:
            likelihood = likelihood + extra
            if not (likelihood < np.inf).all():
                raise InputError("extra must be below infinity and no NaN; minus infinity is allowed")
        self.log_belief[users] = update(self.log_belief[users], likelihood).log_belief
