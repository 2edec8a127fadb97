"""Base of signals made of steps: P(outcome | state, action; type, policy) for next states or rewards as numbers.

Steps are independent given the type, as in an MDP, so an episode's log likelihood is a sum. A table holds n_types
× n_states × n_actions × n_outcomes numbers, times n_policies where outcomes depend on the policy beyond its
actions. Thesis: §4.4.2.1–2, §4.7.6.
"""

from collections.abc import Iterable, Sequence
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.law import FixedLaw, Models
from lifelore.interaction.outcomes.log_probability import (
    checked_counts,
    checked_distributions,
    checked_pseudo_count,
    log_of,
)
from lifelore.interaction.outcomes.outcome_rows import check_known, chosen_of
from lifelore.interaction.signals.step_law import StepLaw

Array = NDArray[np.float64]

_AXES = ("n_types", "n_policies or 1", "n_states", "n_actions", "n_outcomes")
_ABOVE = 2e-6
"""Largest logarithm of a probability that is accepted: rows may sum to 1 + 1e-6."""


class StepModel:
    """Base of `TransitionSignal` and `StepRewardSignal`.

    Parameters
    ----------
    probs : (n_types, n_states, n_actions, n_outcomes) or (n_types, n_policies, n_states, n_actions, n_outcomes)
        Rows over outcomes sum to 1; zeros are allowed. Without the policies' axis all policies share the table.
    n_policies : int, optional
        Number of policies that share the table; any number where None.
    count : float or array of the shape of `probs` without its last axis, optional
        Number of steps behind each row, pseudo-counts included; without it rows are exact.

    Raises
    ------
    InputError
        A row is no distribution, or a count is not positive.
    """

    kind: ClassVar[str]
    n_policies: int | None
    totals: Array | None

    def __init__(self, probs: ArrayLike, n_policies: int | None = None, count: ArrayLike | None = None) -> None:
        probs = np.asarray(probs, np.float64)
        self.shared = probs.ndim == 4
        table = checked_distributions(probs[:, None] if self.shared else probs, "probs", _AXES)
        self.n_policies = n_policies if self.shared else table.shape[1]
        # Types last: a step reads a row.
        self.log_table = log_of(np.ascontiguousarray(np.moveaxis(table, 0, -1)))
        self.totals = None
        if count is not None:
            totals = checked_counts(count, probs.shape[:-1])
            self.totals = np.ascontiguousarray(np.moveaxis(totals[:, None] if self.shared else totals, 0, -1))

    @property
    def n_types(self) -> int:
        return self.log_table.shape[-1]

    @property
    def shape(self) -> tuple[int, int, int]:
        """(n_states, n_actions, n_outcomes)."""
        return self.log_table.shape[1:4]

    @property
    def probs(self) -> Array:
        """P(outcome | state, action; type[, policy]), axes as given; computed at each call."""
        table = np.moveaxis(np.exp(self.log_table), -1, 0)
        return table[:, 0] if self.shared else table

    @property
    def n_entries(self) -> int:
        """Number of stored probabilities."""
        return self.log_table.size

    def log_likelihood(self, policy: int, signal: Any) -> Array:
        """Log likelihood of an episode's steps per type, (n_types,); 0 for no steps.

        Raises
        ------
        InputError
            The signal is not made of steps, or a step is outside the table.
        NotFoundError
            There is no such policy.
        """
        return self.log_table[self.places_of(policy, signal)].sum(axis=0)

    def places_of(self, policy: int, signal: Any) -> tuple[NDArray[np.int64], ...]:
        """Table, state, action and outcome of each step, (n,) each; errors as for `log_likelihood`."""
        if self.n_policies is not None:
            check_known("policy", policy, self.n_policies)
        steps = self.steps_of(signal)
        check_steps(steps, self.shape)
        return np.full(len(steps), 0 if self.shared else policy), *steps.T

    def steps_of(self, signal: Any) -> NDArray[np.int64]:
        """A signal as steps (n, 3): state, action, number of the outcome."""
        raise NotImplementedError

    def law(self, models: Models = "uncertain", **_: Any) -> Any:
        """The law of episodes given what users have shown; fixed where all is exact, or taken for the truth."""
        return StepLaw(self) if models == "uncertain" and self.totals is not None else FixedLaw(self, self.n_types)

    def taken(
        self, types: Sequence[int] | None, policies: Sequence[int] | None
    ) -> tuple[Array, int | None, Array | None]:
        """The table of some types and policies, the number of policies that share it, the steps behind rows."""
        some = chosen_of(types, self.n_types)
        table = self.probs[some]
        count = None if self.totals is None else np.moveaxis(self.totals, -1, 0)[some]
        if self.shared:
            n_policies = self.n_policies if policies is None else len(policies)
            return table, n_policies, None if count is None else count[:, 0]
        chosen = chosen_of(policies, table.shape[1])
        return table[:, chosen], None, None if count is None else count[:, chosen]

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """The logarithms, and the number of policies that share them."""
        totals = {} if self.totals is None else {"totals": self.totals}
        return {"log": self.log_table, "shared": np.array([self.shared, self.n_policies or 0]), **totals}

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        """The model of `to_arrays`, bit for bit."""
        log, (shared, n_policies) = np.array(arrays["log"], np.float64), arrays["shared"].tolist()
        if log.ndim != 5 or not log.size or not (log <= _ABOVE).all() or (shared and len(log) != 1):
            raise InputError("log must be logarithms of probabilities by policy, state, action, outcome, type")
        model = cls.__new__(cls)
        model.log_table, model.shared, model.n_policies = log, bool(shared), int(n_policies) or None
        model.totals = np.array(arrays["totals"], np.float64) if "totals" in arrays else None
        if model.totals is not None and model.totals.shape != (*log.shape[:3], log.shape[4]):
            raise InputError("totals must be the steps behind each row, by policy, state, action, type")
        return model


def check_steps(steps: NDArray[np.int64], shape: tuple[int, int, int]) -> None:
    """Raise InputError for steps (n, 3) outside (n_states, n_actions, n_outcomes)."""
    if len(steps) and not ((steps >= 0).all() and (steps < shape).all()):
        bad = steps[((steps < 0) | (steps >= shape)).any(axis=1)][0]
        raise InputError(f"each step must be below {shape} (states, actions, outcomes), got {tuple(bad.tolist())}")


def step_counts(
    steps: Iterable[tuple[int, int, NDArray[np.int64]]],
    n_types: int,
    n_policies: int | None,
    shape: tuple[int, int, int],
) -> Array:
    """Number of times of each step: (n_types, *shape), with `n_policies` (n_types, n_policies, *shape).

    Parameters
    ----------
    steps : iterable of (type, policy, (n, 3) int)
        Episodes of known types.
    shape : (n_states, n_actions, n_outcomes)
    """
    counts = np.zeros((n_types, n_policies or 1, *shape))
    for type_, policy, rows in steps:
        place = 0 if n_policies is None else policy
        if not (0 <= type_ < n_types and 0 <= place < counts.shape[1]):
            raise InputError(f"sequences must name known types and policies, got type {type_}, policy {policy}")
        check_steps(rows, shape)
        np.add.at(counts[type_, place], tuple(rows.T), 1.0)
    return counts[:, 0] if n_policies is None else counts


def step_probs(counts: ArrayLike, pseudo_count: float, possible: ArrayLike | None) -> tuple[Array, Array]:
    """Distributions over outcomes from counts, `pseudo_count` added to each outcome that is `possible`; row sums.

    A row without any count is uniform and counts as one step.

    Parameters
    ----------
    possible : bool, broadcastable to the counts, optional
        Possible outcomes; by default all. Counted outcomes are possible in any case.

    Raises
    ------
    InputError
        A count is negative or not finite, or the pseudo-count is negative.
    """
    counts = np.asarray(counts, np.float64)
    if not counts.size or not ((counts >= 0) & np.isfinite(counts)).all():
        raise InputError("counts must be at least 0 and finite, at least one of them")
    gets = np.broadcast_to(True if possible is None else np.asarray(possible, bool), counts.shape)
    weights = counts + checked_pseudo_count(pseudo_count) * gets
    totals = weights.sum(axis=-1, keepdims=True)
    probs = np.divide(weights, totals, out=np.full_like(weights, 1 / counts.shape[-1]), where=totals > 0)
    return probs, np.where(totals > 0, totals, 1.0)[..., 0]
