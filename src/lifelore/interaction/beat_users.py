"""BEAT for many users at once: one row of log beliefs a user, tables instead of models. See `beat`."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.belief import log_prior
from lifelore.interaction.belief_kernels import bayes_rows

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
    prior : (n_types,) float, optional
        Uniform unless given.
    seed : int or numpy generator

    Attributes
    ----------
    log_belief : (n_users, n_types) float64
        Normalised logs.
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
        n_types, n_policies = self.value.shape
        if self.log_table.ndim != 3 or self.log_table.shape[::2] != (n_policies, n_types):
            raise InputError(
                f"log_table must be ({n_policies}, n_signals, {n_types}) to fit value, got {self.log_table.shape}"
            )
        start = np.full(n_types, 1 / n_types) if prior is None else np.asarray(prior, np.float64)
        self.log_belief: Array = np.array(np.broadcast_to(log_prior(start), (n_users, n_types)))
        self._generator = np.random.default_rng(seed)

    def select(self, users: NDArray[np.int64], epsilon: ArrayLike = 0.0) -> NDArray[np.int64]:
        """The action set for the next step of `users` (n,): of equals the first, by chance with `epsilon` (n,)."""
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
        """Take in one signal of each of `users`, seen under `policies`.

        `extra` (n, n_types) is the log of a second factor of the likelihood.
        """
        likelihood = self.log_table[policies, signals]
        if extra is not None:
            likelihood = likelihood + extra
        beliefs = np.ascontiguousarray(self.log_belief[users])
        evidence = np.empty(len(users))
        bayes_rows(beliefs, np.ascontiguousarray(likelihood), evidence)
        self.log_belief[users] = beliefs
