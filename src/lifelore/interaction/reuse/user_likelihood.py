"""Log likelihoods for many users at once: a kernel for the common models, the model's own way for others."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.log_probability import log_of
from lifelore.interaction.outcomes.outcome_model import LARGEST
from lifelore.interaction.reuse.user_kernels import gaussian_said, table_said
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.return_signal import ReturnSignal

Said = Callable[[NDArray[np.int64], Any, NDArray[np.float64]], None]
"""Writes log likelihoods (k, n_types) of signals (k) of policies (k,) into the last argument."""


def said_by(library: PolicyLibrary) -> tuple[Said, Callable[[Any], Any]]:
    """How the library's signals are turned into log likelihoods, and how a batch of them is checked first.

    Model arrays are copied: a library that learns in place needs this anew.
    """
    signal = library.signal
    if (rows := rows_of_normals(signal)) is not None:
        return _gaussian(*rows), _finite
    if isinstance(signal, CategorySignal):
        return _category(signal), _whole(signal.n_categories)
    if isinstance(signal, ReturnSignal):
        return _by_model(signal.log_likelihoods), _finite
    many = getattr(signal, "log_likelihoods", None)
    return (_one_by_one(signal), list) if many is None else (_by_model(many), np.ascontiguousarray)


def rows_of_normals(signal: Any) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]] | None:
    """Mean, 1 / deviation and log height of normal returns, (n_policies, n_types) each; None for other signals.

    These are the model's own arrays, so that what it learns in place is seen at once.
    """
    if not isinstance(signal, ReturnSignal) or type(signal).log_likelihood is not ReturnSignal.log_likelihood:
        return None
    outcomes = signal.outcomes
    if type(outcomes) is not GaussianOutcomes:
        return None
    return outcomes._centre, outcomes._precision, outcomes._log_height


def _gaussian(mean: NDArray[np.float64], precision: NDArray[np.float64], height: NDArray[np.float64]) -> Said:
    def said(policies: NDArray[np.int64], signals: Any, out: NDArray[np.float64]) -> None:
        gaussian_said(policies, signals, mean, precision, height, out)

    return said


def _category(signal: CategorySignal) -> Said:
    logs = log_of(np.ascontiguousarray(signal.probs.transpose(1, 2, 0)))

    def said(policies: NDArray[np.int64], signals: Any, out: NDArray[np.float64]) -> None:
        table_said(policies, signals, logs, out)

    return said


def _by_model(many: Callable[[Any, Any], NDArray[np.float64]]) -> Said:
    def said(policies: NDArray[np.int64], signals: Any, out: NDArray[np.float64]) -> None:
        out[:] = many(policies, signals)
        _check(out)

    return said


def _one_by_one(signal: Any) -> Said:
    def said(policies: NDArray[np.int64], signals: Any, out: NDArray[np.float64]) -> None:
        for k, (policy, one) in enumerate(zip(policies.tolist(), signals, strict=True)):
            out[k] = signal.log_likelihood(policy, one)
        _check(out)

    return said


def _check(said: NDArray[np.float64]) -> None:
    if not (said < np.inf).all():
        raise InputError("the signal model gave NaN or infinity as a log likelihood; minus infinity is allowed")


def _finite(signals: ArrayLike) -> NDArray[np.float64]:
    values = np.ascontiguousarray(signals, np.float64)
    if not (np.abs(values) <= LARGEST).all():
        raise InputError(f"signals must be finite numbers of at most {LARGEST:g}; leave out what has no outcome")
    return values


def _whole(n_categories: int) -> Callable[[ArrayLike], NDArray[np.int64]]:
    def checked(signals: ArrayLike) -> NDArray[np.int64]:
        values = np.ascontiguousarray(signals)
        if values.dtype.kind not in "iu" or (values.size and not 0 <= values.min() <= values.max() < n_categories):
            raise InputError(f"signals must be category numbers 0 to {n_categories - 1}")
        return values.astype(np.int64, copy=False)

    return checked
