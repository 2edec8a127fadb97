"""The interface of laws: log likelihoods of signals for users and all types, given what each user has shown.

A library's runs leave open what a type pays. What a user shows then tells of the type and of the parameters of the
user's own outcomes. A law has sufficient statistics of that, `shown`, an array with a leading axis of users, and
predicts the next signal from them:

    log F(σ | τ, π, spread, shown)           `log_likelihoods`
    shown ← shown and σ                      `learn`

Models that are exact, or taken for the truth ("plug-in"), learn nothing from a user: `FixedLaw`. Leading axes are
users: a single user has none, its number, policy and signal are scalars.
"""

from collections.abc import Callable, Mapping
from math import prod
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[Any]
Numbers = Any
"""A number, or an array (k,) of whole numbers."""
Models = Literal["uncertain", "plug-in"]


class Law:
    """The law of a library's signals, or of its outcomes; base class.

    Laws of outcomes, and of signals that can be listed, also have ``prediction(shown, users, log_weights)``: what
    rules read of the next outcome or signal of `users` with log probabilities (..., n_spreads) of their spreads.
    Its ``table(n_bins)`` is P(next signal | type, policy), a `SignalTable` of at most `n_bins` bins.

    Attributes
    ----------
    spread : Spread
        Possible spreads of the users of a type.
    shape : tuple of int
        Of the statistics of a user.
    learns : bool
        Whether users' signals change the law.
    single : bool
        Whether a signal is a single number once it is checked, so that there must be one for each user.
    amounts : index
        The numbers of a row of statistics that are at least 0.
    """

    n_types: int
    spread: Spread
    shape: tuple[int, ...]
    dtype: Any = np.dtype("f8")
    learns, single = True, True
    amounts: Any = slice(None)

    def checked(self, signals: Any) -> Any:
        """The signals (k,) as the other methods take them; InputError where the law cannot have made one."""
        return signals

    def shown(self, n_users: int) -> Array:
        """The statistics of users who have shown nothing, (n_users, ...)."""
        return np.zeros((n_users, *self.shape), self.dtype)

    def log_likelihoods(
        self, policies: Numbers, signals: Any, shown: Array | None = None, users: Numbers = None
    ) -> Array:
        """log F of signals (...) given what `users` (...) have shown, (..., n_spreads, n_types).

        Without `shown`, of users who have shown nothing.
        """
        raise NotImplementedError

    def learn(self, shown: Array, users: Numbers, policies: Numbers, signals: Any) -> None:
        """Add signals of distinct users to what they have shown."""
        raise NotImplementedError

    def fade(self, shown: Array, users: Numbers, keep: ArrayLike) -> None:
        """Let everything that distinct `users` have shown count `keep` (...) of what it did."""
        shown[users] *= np.asarray(keep, self.dtype)[(..., *[None] * len(self.shape))]

    def state(self, shown: Array, user: int) -> dict[str, Array]:
        """What a single user has shown: ``places`` (m, k) of the rows that are not 0; ``shown`` (m, n_numbers)."""
        places = np.argwhere(shown[user].any(axis=-1))
        return {"places": places, "shown": shown[user][tuple(places.T)]}

    def restore(self, shown: Array, user: int, state: Mapping[str, Array]) -> None:
        """Take over a `state`; InputError where it is of another law."""
        # Sessions before version 4 have numbers of policies.
        places = np.asarray(state["places"] if "places" in state else np.reshape(state["policies"], (-1, 1)))
        rows, (*limits, n_numbers) = np.asarray(state["shown"], np.float64), self.shape
        good = places.shape == (len(rows), len(limits)) and rows.shape[1:] == (n_numbers,)
        if not (good and np.isfinite(rows).all() and (rows[:, self.amounts] >= 0).all()):
            raise InputError(f"a user's state must have rows of {n_numbers} numbers, finite, amounts at least 0")
        if not ((places >= 0) & (places < limits)).all():
            raise InputError(f"a user's state must have places below {tuple(limits)}")
        shown[user] = 0
        shown[user][tuple(places.T)] = rows


def of_users(rows: Array, users: Numbers) -> Array:
    """The rows of users (...); of a single user not a copy."""
    # Rows that lie far apart in memory are read twice as fast by `take` as by an index.
    return rows.take(users, axis=0) if isinstance(users, np.ndarray) else rows[users]


def filled(
    shape: tuple[int, ...], at: tuple[Array, Array], untried: Array, tried: Array, n_policies: int
) -> Array:
    """Numbers of each user and pair, (*shape, n_types, n_policies, ...).

    Parameters
    ----------
    at : rows and policies, (m,) each, of the pairs of a user and a policy that the user has tried
    untried : ([k,] n_types, n_policies, ...)
    tried : (m, n_types, ...)
    """
    n_types, *more = tried.shape[1:]
    found = np.empty((prod(shape), n_types, n_policies, *more), untried.dtype)
    found[...] = untried
    found[at[0], :, at[1]] = tried
    return found.reshape(*shape, *found.shape[1:])


class FixedLaw(Law):
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

    learns, shape = False, (0,)

    def __init__(
        self,
        model: Any,
        n_types: int,
        log_likelihoods: Callable[[Numbers, Any], Array] | None = None,
        check: Callable[[Any], Any] | None = None,
    ) -> None:
        self.model, self.n_types, self.spread = model, n_types, Spread.known(0.0)
        self.single = check is not None
        # The model's own functions, so that a signal passes through no others.
        self.checked: Any = check or super().checked
        self.log_likelihoods: Callable[..., Array] = log_likelihoods or self._one_by_one

    def _one_by_one(self, policies: Numbers, signals: Any) -> Array:
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
        if not (found < np.inf).all():
            raise InputError(
                f"signal model {type(self.model).__name__} gave NaN or infinity as a log likelihood; "
                "minus infinity is allowed, they are not"
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
