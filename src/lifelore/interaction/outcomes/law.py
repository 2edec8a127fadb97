"""The interface of laws: log likelihoods of signals for users and all types, given what each user has shown.

A library's runs leave open what a type pays. What a user shows then tells of the type and of the parameters of the
user's own outcomes. A law has sufficient statistics of that, `Shown`, and predicts the next signal from them:

    log F(σ | τ, π, spread, shown)           `log_likelihoods`
    shown ← shown and σ                      `learn`

Models that are exact, or taken for the truth ("plug-in"), learn nothing from a user: `FixedLaw`. Leading axes are
users: a single user has none, its number, policy and signal are scalars.
"""

from collections.abc import Callable, Mapping
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[Any]
Numbers = Any
"""A number, or an array (k,) of whole numbers."""
Models = Literal["uncertain", "plug-in"]


class Shown:
    """What users have shown: sufficient statistics by name, arrays with a leading axis of users."""

    def __init__(self, **arrays: Array) -> None:
        self.arrays = arrays

    def __getitem__(self, name: str) -> Array:
        return self.arrays[name]

    def reset(self, users: Numbers) -> None:
        """Forget what `users` have shown."""
        for array in self.arrays.values():
            array[users] = 0

    def grow(self, n_users: int) -> None:
        """Make room for `n_users` users; new users have shown nothing."""
        for name, array in self.arrays.items():
            grown = np.zeros((n_users, *array.shape[1:]), array.dtype)
            grown[: len(array)] = array
            self.arrays[name] = grown

    @property
    def nbytes(self) -> int:
        """Memory in bytes."""
        return sum(array.nbytes for array in self.arrays.values())


class Law(Protocol):
    """The law of a library's signals, or of its outcomes.

    Attributes
    ----------
    spread : Spread
        Possible spreads of the users of a type.
    learns : bool
        Whether users' signals change the law.
    single : bool
        Whether a signal is a single number once it is checked, so that there must be one for each user.
    """

    n_types: int
    spread: Spread
    learns: bool
    single: bool

    def checked(self, signals: Any) -> Any:
        """The signals (k,) as the other methods take them; InputError where the law cannot have made one."""
        ...

    def shown(self, n_users: int) -> Shown:
        """The statistics of users who have shown nothing."""
        ...

    def log_likelihoods(
        self, policies: Numbers, signals: Any, shown: Shown | None = None, users: Numbers = None
    ) -> Array:
        """log F of signals (...) given what `users` (...) have shown, (..., n_spreads, n_types).

        Without `shown`, of users who have shown nothing.
        """
        ...

    def learn(self, shown: Shown, users: Numbers, policies: Numbers, signals: Any) -> None:
        """Add signals of distinct users to what they have shown."""
        ...

    def fade(self, shown: Shown, users: Numbers, keep: ArrayLike) -> None:
        """Let everything that distinct `users` have shown count `keep` (...) of what it did."""
        ...

    def table(self, n_bins: int, shown: Shown, users: Numbers, log_weights: Array) -> SignalTable:
        """P(next signal | type, policy) of `users` in at most `n_bins` bins; laws without one have no such method.

        Parameters
        ----------
        log_weights : (..., n_spreads) float
            Log probabilities of the spreads for each of `users`.
        """
        ...

    def state(self, shown: Shown, user: int) -> dict[str, Array]:
        """What a single user has shown, as small arrays that do not depend on the law's precision."""
        ...

    def restore(self, shown: Shown, user: int, state: Mapping[str, Array]) -> None:
        """Take over a `state`; InputError where it is of another law."""
        ...


class FixedLaw:
    """The law of a model that users' signals do not change: nothing is learnt, forgotten or stored.

    Parameters
    ----------
    model : SignalModel
    log_likelihoods : callable, optional
        ``log_likelihoods(policies, signals)`` gives (..., n_types) of checked signals; by default the model's
        `log_likelihood` is called for each signal.
    check : callable, optional
        Signals (k,) to what `log_likelihoods` takes.
    """

    learns = False

    def __init__(
        self,
        model: Any,
        n_types: int,
        log_likelihoods: Callable[[Numbers, Any], Array] | None = None,
        check: Callable[[Any], Any] | None = None,
    ) -> None:
        self.model, self.n_types, self.spread = model, n_types, Spread.known(0.0)
        self._many, self._check, self.single = log_likelihoods, check, check is not None

    def checked(self, signals: Any) -> Any:
        """The signals as the model takes them."""
        return signals if self._check is None else self._check(signals)

    def shown(self, n_users: int) -> Shown:
        """Nothing."""
        return Shown()

    def log_likelihoods(
        self, policies: Numbers, signals: Any, shown: Shown | None = None, users: Numbers = None
    ) -> Array:
        """The model's own log likelihoods, (..., n_types): there are no spreads."""
        if self._many is not None:
            return self._many(policies, signals)
        if np.ndim(policies) == 0:
            return self._one(policies, signals)
        return np.array([self._one(*pair) for pair in zip(policies.tolist(), signals, strict=True)])

    def _one(self, policy: int, signal: Any) -> Array:
        # A copy: callers keep it, and a model may write its next answer into the same array.
        found = np.array(self.model.log_likelihood(policy, signal), np.float64)
        if found.shape != (self.n_types,):
            raise InputError(
                f"signal model {type(self.model).__name__} must give ({self.n_types},) log likelihoods, gave "
                f"{found.shape}"
            )
        return found


def law_of(model: Any, n_types: int, models: Models = "uncertain", **settings: Any) -> Any:
    """The law that a signal or outcome model offers by its method `law`, else the fixed law of its likelihoods.

    Parameters
    ----------
    models : {"uncertain", "plug-in"}
        Whether what the runs leave open counts, or estimates are taken for the truth.
    **settings
        ``dtype`` of the statistics, and the `Spread`, for laws that learn.
    """
    if (offered := getattr(model, "law", None)) is not None:
        return offered(models, **settings)
    return FixedLaw(model, n_types)
