"""Likelihood signal: a signal model by the caller's own log likelihood function."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.simulated_table import Sample
from lifelore.interaction.outcomes.outcome_rows import check_known, chosen_of

Array = NDArray[np.float64]


class LikelihoodSignal:
    """Signals of any kind, with a log likelihood by the caller.

    Parameters
    ----------
    function : callable
        ``function(policy, signal)`` gives log likelihoods (n_types,); -inf is allowed, NaN and +inf are not.
    n_types : int
    n_policies : int, optional
        Checked where given.
    sample : callable, or sequences of stored signals, optional
        ``sample(generator, type, policy)`` draws an episode's signal, or ``sample[type][policy]`` holds some, at
        least one. Rules that look ahead, the default too, then know what a policy will tell; without it the
        default rule is greedy.

    Examples
    --------
    >>> signal = LikelihoodSignal(lambda policy, words: [-len(words), -1.0], n_types=2)
    >>> signal.log_likelihood(0, "abc").tolist()
    [-3.0, -1.0]
    """

    def __init__(
        self,
        function: Callable[[int, Any], ArrayLike],
        n_types: int,
        n_policies: int | None = None,
        sample: Sample | Sequence[Sequence[Sequence[Any]]] | None = None,
    ) -> None:
        if n_types < 1:
            raise InputError(f"n_types must be at least 1, got {n_types}")
        self.function, self.n_types, self.n_policies = function, n_types, n_policies
        self.sample: Sample | None = sample if sample is None or callable(sample) else partial(_stored, sample)

    def log_likelihood(self, policy: int, signal: Any) -> Array:
        """The checked answer of the function.

        Raises
        ------
        InputError
            It gave another shape, NaN or +inf.
        NotFoundError
            There is no such policy.
        """
        if self.n_policies is not None:
            check_known("policy", policy, self.n_policies)
        name = getattr(self.function, "__name__", type(self.function).__name__)
        try:
            found = np.asarray(self.function(policy, signal), np.float64)
        except (TypeError, ValueError) as error:
            raise InputError(f"log likelihood {name!r} gave no numbers for policy {policy}: {error}") from error
        if found.shape != (self.n_types,):
            raise InputError(f"log likelihood {name!r} must give ({self.n_types},) numbers, gave {found.shape}")
        if not (found < np.inf).all():
            raise InputError(f"log likelihood {name!r} must be below inf and no NaN, gave {found!r:.80}")
        return found

    def take(
        self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None
    ) -> "LikelihoodSignal":
        """The model of some types and policies."""
        chosen = chosen_of(types, self.n_types)
        some = None if policies is None else tuple(map(int, policies))
        cut = partial(_part, self.function, chosen, some)
        sample = None if self.sample is None else partial(_sample_part, self.sample, chosen, some)
        return LikelihoodSignal(cut, len(chosen), self.n_policies if some is None else len(some), sample)


def _part(
    function: Callable[[int, Any], ArrayLike],
    types: NDArray[np.int64],
    policies: tuple[int, ...] | None,
    policy: int,
    signal: Any,
) -> Array:
    """A caller's function for some types and policies; not a closure, which could not be pickled."""
    return np.asarray(function(policy if policies is None else policies[policy], signal))[types]


def _sample_part(
    sample: Sample,
    types: NDArray[np.int64],
    policies: tuple[int, ...] | None,
    generator: np.random.Generator,
    type_: int,
    policy: int,
) -> Any:
    """A caller's samples for some types and policies."""
    return sample(generator, int(types[type_]), policy if policies is None else policies[policy])


def _stored(stored: Sequence[Any], generator: np.random.Generator, type_: int, policy: int) -> Any:
    """One of the stored signals of a type and policy."""
    signals = stored[type_][policy]
    if not len(signals):
        raise InputError(f"sample must hold signals of each type and policy, none of {type_} and {policy}")
    return signals[int(generator.integers(len(signals)))]
