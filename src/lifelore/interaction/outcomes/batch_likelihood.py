"""Log likelihoods of many signals at once: by a compiled kernel where the model has arrays for it, else by calls.

A signal or outcome model offers one of these through its method `batch_likelihood`. Policy reuse then needs no
knowledge of the model's class.
"""

from collections.abc import Callable
from functools import cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.outcome_model import LARGEST

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]


class Normals(NamedTuple):
    """Parameters of normal distributions, (n_policies, n_types) each, as the kernels read them.

    mean : float64
    precision : float64
        1 / deviation.
    log_height : float64
        Log density at the mean.
    """

    mean: Array
    precision: Array
    log_height: Array


class BatchLikelihood:
    """Base: log likelihoods of k signals under a model of n_types types.

    normals : Normals or None
        The model's arrays where signals are numbers under normals; a single signal then needs one kernel call.
    """

    normals: Normals | None = None

    def checked(self, signals: Any) -> Any:
        """The signals (k,) as `write` takes them; InputError where the model cannot have made one of them."""
        raise NotImplementedError

    def write(self, policies: Numbers, signals: Any, log_likelihood: Array) -> None:
        """Write log F(signal | type, policy) of checked signals (k,) into `log_likelihood` (k, n_types)."""
        raise NotImplementedError


class NormalLikelihood(BatchLikelihood):
    """Real-valued signals under normals. The arrays are the model's own: changes in place take effect at once."""

    def __init__(self, normals: Normals) -> None:
        self.normals, self._arrays = normals, normals

    def checked(self, signals: ArrayLike) -> Array:
        """Finite numbers (k,)."""
        return finite_signals(signals)

    def write(self, policies: Numbers, signals: Array, log_likelihood: Array) -> None:
        """Log densities, by a kernel."""
        _kernels().normal_rows(policies, signals, *self._arrays, log_likelihood)


class TableLikelihood(BatchLikelihood):
    """Category numbers under a table of log probabilities (n_policies, n_categories, n_types), not copied."""

    def __init__(self, log_probs: Array) -> None:
        self.log_probs = log_probs

    def checked(self, signals: ArrayLike) -> Numbers:
        """Category numbers (k,)."""
        values, n_categories = np.ascontiguousarray(signals), self.log_probs.shape[1]
        if values.dtype.kind not in "iu" or (values.size and not 0 <= values.min() <= values.max() < n_categories):
            raise InputError(f"signals must be category numbers 0 to {n_categories - 1}")
        return values.astype(np.int64, copy=False)

    def write(self, policies: Numbers, signals: Numbers, log_likelihood: Array) -> None:
        """Rows of the table, by a kernel."""
        _kernels().table_rows(policies, signals, self.log_probs, log_likelihood)


class CalledLikelihood(BatchLikelihood):
    """Signals of a model that computes many log likelihoods in one call."""

    def __init__(
        self,
        log_likelihoods: Callable[[Numbers, Any], Array],
        check: Callable[[Any], Any] = np.ascontiguousarray,
    ) -> None:
        self.log_likelihoods, self.check = log_likelihoods, check

    def checked(self, signals: Any) -> Any:
        """The signals as `check` gives them."""
        return self.check(signals)

    def write(self, policies: Numbers, signals: Any, log_likelihood: Array) -> None:
        """The model's own numbers; InputError where one is NaN or infinity."""
        log_likelihood[:] = self.log_likelihoods(policies, signals)
        _check(log_likelihood)


class LoopedLikelihood(BatchLikelihood):
    """Signals of a model that computes one log likelihood a call, such as a caller's own function."""

    def __init__(self, log_likelihood: Callable[[int, Any], Array]) -> None:
        self.log_likelihood = log_likelihood

    def checked(self, signals: Any) -> list[Any]:
        """The signals as a list; the model checks each."""
        return list(signals)

    def write(self, policies: Numbers, signals: list[Any], log_likelihood: Array) -> None:
        """The model's own numbers; InputError where one is NaN or infinity."""
        for row, policy, signal in zip(log_likelihood, policies.tolist(), signals, strict=True):
            row[:] = self.log_likelihood(policy, signal)
        _check(log_likelihood)


def batch_likelihood(model: Any) -> BatchLikelihood:
    """The likelihood that `model` offers; for a model without one, its `log_likelihoods` or `log_likelihood`."""
    if (offered := getattr(model, "batch_likelihood", None)) is not None:
        return offered()
    if (many := getattr(model, "log_likelihoods", None)) is not None:
        return CalledLikelihood(many)
    return LoopedLikelihood(model.log_likelihood)


def finite_signals(signals: ArrayLike) -> Array:
    """Signals (k,) as float64; InputError where one is not finite."""
    values = np.ascontiguousarray(signals, np.float64)
    if not (np.abs(values) <= LARGEST).all():
        raise InputError(f"signals must be finite numbers of at most {LARGEST:g}; leave out what has no outcome")
    return values


def _check(log_likelihood: Array) -> None:
    if not (log_likelihood < np.inf).all():
        raise InputError("the signal model gave NaN or infinity as a log likelihood; minus infinity is allowed")


@cache
def _kernels() -> ModuleType:
    # Imported at the first use: the import starts Numba.
    from lifelore.interaction.outcomes import likelihood_kernels

    return likelihood_kernels
