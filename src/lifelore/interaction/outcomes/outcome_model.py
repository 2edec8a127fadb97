"""What all outcome models have in common: spread, law, and learning from outcomes whose type is known.

Thesis: §4.3.4, Def. 4.3.4.
"""

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.law import FixedLaw, Models
from lifelore.interaction.outcomes.outcome_rows import (
    OutcomeRows,
    check_known,
    check_outcome,
    finite_outcomes,
    rows_of_more,
)
from lifelore.interaction.outcomes.prediction import Prediction
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[np.float64]


class OutcomeModel(Prediction):
    """P(U | type, policy); base of models by moments and by counts. Only `observe` and `absorb` change a model."""

    kind: ClassVar[str]
    bounds: Callable[[], tuple[float, float]]
    """(U^min, U^max)."""
    table: Callable[..., SignalTable]
    """The outcome as a signal of at most `n_bins` bins that tell the types apart."""
    take: Callable[..., Self]
    """A new model of some types and policies, in the order given; None means all."""
    _spread: Spread | None = None
    _estimated_spread: Callable[[], Spread]
    _uncertain_law: Callable[[Spread, str], Any]
    """The law of models that are known to be uncertain; None where all is exact."""
    _count: Callable[[int, int, float], None]
    _count_all: Callable[[int, Mapping[str, Any]], None]
    _more: Callable[[OutcomeRows, int], Self]
    """With the additional type (axis 0) or policy (axis 1) of rows."""
    _parameters: Callable[[], dict[str, NDArray[Any]]]
    _prepare: Callable[[], None]
    """Compute all arrays that follow from the parameters."""

    @property
    def spread(self) -> Spread:
        """How much the tasks of a type differ; estimated at the first call where it is not given."""
        if self._spread is None:
            self._spread = self._estimated_spread()
        return self._spread

    @spread.setter
    def spread(self, spread: Spread) -> None:
        self._spread = spread
        self._laws.clear()

    def law(self, models: Models = "uncertain", *, spread: Spread | None = None, dtype: str = "f8") -> Any:
        """The law of outcomes given what users have shown; a fixed law where all is exact, or taken for the truth.

        Parameters
        ----------
        spread : Spread, optional
            By default the model's own.
        dtype : {"f8", "f4"}
        """
        if models == "plug-in":
            learns = None
        elif spread is not None:
            learns = self._uncertain_law(spread, dtype)
        else:
            if dtype not in self._laws:
                self._laws[dtype] = self._uncertain_law(self.spread, dtype)
            learns = self._laws[dtype]
        return learns or FixedLaw(self, self.n_types, self.log_densities, finite_outcomes)

    @cached_property
    def _laws(self) -> dict[str, Any]:
        """Laws with the model's own spread by dtype, shared by all tasks until the model learns in place."""
        return {}

    def log_density(self, policy: int, value: float) -> Array:
        """Log density of `value` per type, (n_types,); minus infinity where it is impossible.

        Raises
        ------
        InputError
            `value` is no finite number.
        NotFoundError
            There is no such policy.
        """
        check_outcome(policy, value, self.n_policies)
        return self.log_densities(policy, value)

    def log_densities(self, policies: Any, values: Any) -> Array:
        """`log_density` of many outcomes, (...) and (...) to (..., n_types); without checks."""
        raise NotImplementedError

    def observe(self, type_: int, policy: int, value: float) -> None:
        """Learn from another outcome of a known type, in place.

        Raises
        ------
        InputError
            `value` is no finite number or in no cell, or the model is exact.
        NotFoundError
            There is no such type or policy.
        """
        check_known("type", type_, self.n_types)
        check_outcome(policy, value, self.n_policies)
        self._count(type_, policy, value)
        self._prepare()
        self._laws.clear()

    def absorb(self, type_: int, state: Mapping[str, Any]) -> None:
        """Learn from all outcomes of a task whose type has become known, in place.

        `state` is what its law gives of them, see `Law.state`.
        """
        check_known("type", type_, self.n_types)
        self._count_all(type_, state)
        self._prepare()
        self._laws.clear()

    def with_type(self, samples: ArrayLike, gaps: bool = False) -> Self:
        """A new model with an additional type, from `samples` (n_policies, n), NaN where missing.

        With `gaps`, policies without a sample are guessed from the other types, by models that can.
        """
        return self._more(rows_of_more(samples, self.n_policies, 0, gaps), 0)

    def with_policy(self, samples: ArrayLike, gaps: bool = False) -> Self:
        """A new model with an additional policy, from `samples` (n_types, n); see `with_type`."""
        return self._more(rows_of_more(samples, self.n_types, 1, gaps), 1)

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """Parameters by name, and the spread where it is known."""
        return self._parameters() | ({} if self._spread is None else {"spread": np.array(self._spread)})


def stored_spread(arrays: Mapping[str, NDArray[Any]]) -> Spread | None:
    """The spread among a model's `to_arrays`."""
    return Spread.of_array(arrays["spread"]) if "spread" in arrays else None
