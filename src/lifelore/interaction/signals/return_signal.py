"""Return signal: the episode's return is the signal, the performance model is the observation model.

Thesis: §4.4.2.3.
"""

from collections.abc import Sequence
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.law import FixedLaw, Models, law_of
from lifelore.interaction.outcomes.outcome_model import OutcomeModel

Array = NDArray[np.float64]


class ReturnSignal:
    """Signals that are outcomes: F(σ) = P(U = σ | type, policy).

    Parameters
    ----------
    outcomes : OutcomeModel
        Not copied: the signal model uses what the outcomes learn in place.

    Examples
    --------
    >>> from lifelore import PolicyLibrary
    >>> library = PolicyLibrary.from_means([[9.0, 5.0], [4.0, 8.0]], 2.0)
    >>> ReturnSignal(library.performance).log_likelihood(0, 9.0).round(2).tolist()
    [-1.61, -4.74]
    """

    kind: ClassVar[str] = "return"
    inner: ClassVar[str] = "outcomes"
    """Name of the model or models within it."""

    def __init__(self, outcomes: OutcomeModel) -> None:
        self.outcomes, self.n_types, self.n_policies = outcomes, outcomes.n_types, outcomes.n_policies

    def log_likelihood(self, policy: int, signal: float) -> Array:
        """Log density of the return per type, (n_types,).

        Raises
        ------
        InputError
            The return is no finite number.
        NotFoundError
            There is no such policy.
        """
        return self.outcomes.log_density(policy, signal)

    def law(self, models: Models = "uncertain", **settings: Any) -> Any:
        """The outcomes' law; for a subclass with a `log_likelihood` of its own, the fixed law of that."""
        if type(self).log_likelihood is not ReturnSignal.log_likelihood:
            return FixedLaw(self, self.n_types)
        return law_of(self.outcomes, self.n_types, models, **settings)

    def table(self, n_bins: int = 8) -> SignalTable:
        """The return in bins."""
        return self.outcomes.table(n_bins)

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """The model of some types and policies."""
        return type(self)(self.outcomes.take(types, policies))
