"""The policy library: types and policies with their performance model, signal model and prior over types.

Thesis: §4.2 (Alg. 7's requirements), §4.3.4, §4.4.1.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.atomic_write import read_file, write_file
from lifelore.core.errors import InputError
from lifelore.core.protocols import SignalModel
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.finite_signals.simulated_table import simulated_table
from lifelore.interaction.library.library_names import checked_prior, distinct_names, index_of, new_name
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.outcome_columns import rows_of_columns
from lifelore.interaction.outcomes.outcome_kinds import outcome_kind
from lifelore.interaction.outcomes.outcome_model import OutcomeModel
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows, chosen_of, rows_of_samples
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[np.float64]


@dataclass(eq=False)
class PolicyLibrary:
    """The knowledge of policy reuse before it meets a task.

    Parameters
    ----------
    performance : OutcomeModel
        P(U | type, policy).
    signal : SignalModel, optional
        P(signal | type, policy); by default the return is the signal.
    types, policies : sequence of str, optional
        Distinct names; by default "type 0", "policy 0", ….
    prior : (n_types,) float, optional
        G0, the probability of meeting each type; at least 0, sums to 1 to 1e-9. Uniform by default.

    Raises
    ------
    InputError
        The prior is no distribution, names are not distinct, or sizes do not agree.

    Examples
    --------
    >>> library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0, policies=["left", "right"])
    >>> library.index_of_policy("right"), library.prior.tolist()
    (1, [0.5, 0.5])
    """

    performance: OutcomeModel
    signal: SignalModel = None  # pyright: ignore[reportAssignmentType]
    types: tuple[str, ...] = ()
    policies: tuple[str, ...] = ()
    prior: Array = None  # pyright: ignore[reportAssignmentType]
    _tables: dict[int, SignalTable] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        if self.signal is None:
            self.signal = ReturnSignal(self.performance)
        self.types = distinct_names(self.types, self.n_types, "type")
        self.policies = distinct_names(self.policies, self.n_policies, "policy")
        self.prior = checked_prior(self.prior, self.n_types)
        for axis in ("n_types", "n_policies"):
            if (size := getattr(self.signal, axis, getattr(self, axis))) not in (None, getattr(self, axis)):
                raise InputError(f"signal has {axis} {size}, performance has {getattr(self, axis)}")

    @classmethod
    def from_samples(
        cls,
        samples: ArrayLike,
        types: Sequence[str] | None = None,
        policies: Sequence[str] | None = None,
        model: str = "gaussian",
        *,
        weights: ArrayLike | None = None,
        signal: SignalModel | None = None,
        prior: ArrayLike | None = None,
        **options: Any,
    ) -> Self:
        """A library fitted to outcomes `samples` (n_types, n_policies, n), NaN where missing.

        Parameters
        ----------
        model : {"gaussian", "student-t", "histogram", "categorical"}
        weights : (n_types, n_policies, n) float, optional
            Importance of each sample, ≥ 0: reliability weights, see `OutcomeRows.with_weights`.
        **options
            For the model's ``from_samples``: ``shrinkage``, ``gaps``, ``edges``, ``pseudo_count``. With
            ``gaps=True`` pairs without a sample are guessed from the others ("gaussian" and "student-t").

        Raises
        ------
        InputError
            A pair has no sample (without ``gaps``), a sample is infinite, a weight negative, or there is no such
            model.
        """
        rows = rows_of_samples(samples, weights, gaps=options.get("gaps", False))
        return cls.from_rows(rows, types, policies, model, signal=signal, prior=prior, **options)

    @classmethod
    def from_rows(
        cls,
        rows: OutcomeRows,
        types: Sequence[str] | None = None,
        policies: Sequence[str] | None = None,
        model: str = "gaussian",
        *,
        weights: ArrayLike | None = None,
        signal: SignalModel | None = None,
        prior: ArrayLike | None = None,
        **options: Any,
    ) -> Self:
        """A library fitted to rows of outcomes, `weights` (n,) of them optional; see `from_samples`."""
        rows = rows if weights is None else rows.with_weights(weights)
        performance = outcome_kind(model).from_rows(rows, **options)
        return cls(performance, signal, tuple(types or ()), tuple(policies or ()), prior)  # pyright: ignore

    @classmethod
    def from_means(
        cls,
        mean: ArrayLike,
        deviation: ArrayLike,
        types: Sequence[str] | None = None,
        policies: Sequence[str] | None = None,
        *,
        count: ArrayLike | None = None,
        signal: SignalModel | None = None,
        prior: ArrayLike | None = None,
    ) -> Self:
        """A library of Gaussian outcomes, means (n_types, n_policies) and deviations; see `GaussianOutcomes`."""
        performance = GaussianOutcomes(mean, deviation, count)
        return cls(performance, signal, tuple(types or ()), tuple(policies or ()), prior)  # pyright: ignore

    @classmethod
    def from_frame(
        cls,
        frame: Any,
        type: str = "type",
        policy: str = "policy",
        outcome: str = "outcome",
        model: str = "gaussian",
        *,
        weight: str | None = None,
        **options: Any,
    ) -> Self:
        """A library fitted to a table with a row for each episode: of pandas, polars, Arrow, or a mapping.

        Parameters
        ----------
        frame : DataFrame, Arrow table or mapping of str to sequences of one length
        type, policy, outcome : str
            Names of the columns; types and policies are in the order of their first rows.
        weight : str, optional
            Name of a column of weights, see `OutcomeRows.with_weights`.
        model, **options
            As for `from_samples`; also `signal` and `prior`.

        Raises
        ------
        InputError
            A column is missing, lengths differ, an outcome is no finite number, or a pair has no row.
        """
        rows, types, policies = rows_of_columns(frame, type, policy, outcome, weight)
        return cls.from_rows(rows, types, policies, model, **options)

    @property
    def n_types(self) -> int:
        """Number of types."""
        return self.performance.n_types

    @property
    def n_policies(self) -> int:
        """Number of policies."""
        return self.performance.n_policies

    def index_of_policy(self, policy: str | int) -> int:
        """The number of a policy, by name or number; NotFoundError where there is no such policy."""
        return index_of(policy, self.policies, "policy")

    def index_of_type(self, type_: str | int) -> int:
        """The number of a type, by name or number; NotFoundError where there is no such type."""
        return index_of(type_, self.types, "type")

    @property
    def has_table(self) -> bool:
        """Whether `table` can list the signals, bin them, or draw samples of them."""
        signals = (self.signal, *getattr(self.signal, "factors", ()))
        return all(hasattr(signal, "table") for signal in signals) or self._samples

    @property
    def _samples(self) -> bool:
        """Whether the signal model draws signals."""
        return getattr(self.signal, "sample", None) is not None

    def table(self, n_bins: int = 8) -> SignalTable:
        """The table of signals from a finite alphabet, computed once for each `n_bins`; see `forget_tables`.

        Of signals without an alphabet that the signal model can draw, `n_bins` signals of each type and policy
        are the alphabet (`simulated_table`).

        Raises
        ------
        InputError
            There is neither, which belief entropy, knowledge gradient and information-directed need.
        """
        if n_bins not in self._tables:
            signal: Any = self.signal
            if hasattr(signal, "table"):
                self._tables[n_bins] = signal.table(n_bins)
            elif self._samples:
                likelihood, sample = signal.log_likelihood, signal.sample
                self._tables[n_bins] = simulated_table(likelihood, sample, self.n_types, self.n_policies, n_bins)
            else:
                raise InputError(
                    f"{type(signal).__name__} has no finite alphabet of signals; choose a rule that needs none "
                    "(greedy, belief sampling), or give the signal model a method sample(generator, type, policy)"
                )
        return self._tables[n_bins]

    def observe(self, type_: str | int, policy: str | int, value: float) -> None:
        """Learn from another outcome of a known type, in place; tables are computed again when needed."""
        self.performance.observe(self.index_of_type(type_), self.index_of_policy(policy), value)
        self.forget_tables()

    def forget_tables(self) -> None:
        """Drop all tables; call it after the signal model has changed in place."""
        self._tables.clear()

    def with_type(
        self,
        samples: ArrayLike,
        name: str | None = None,
        *,
        signal: SignalModel | None = None,
        mass: float | None = None,
        gaps: bool = False,
    ) -> Self:
        """A library with an additional type.

        Parameters
        ----------
        samples : (n_policies, n) float
            Outcomes of every policy on the new type, NaN where missing.
        name : str, optional
        signal : SignalModel, optional
            Of the new library; required where signals are not returns.
        mass : float, optional
            The new type's prior, in [0, 1); 1 / (n_types + 1) by default. The other types share the rest as
            before.
        gaps : bool
            Whether policies without an outcome are guessed from the other types ("gaussian" and "student-t").
            Models in doubt know how little a guess tells; plug-in models take it for the truth.
        """
        mass = 1 / (self.n_types + 1) if mass is None else float(mass)
        if not 0 <= mass < 1:
            raise InputError(f"mass must lie in [0, 1), got {mass}")
        performance = self.performance.with_type(samples, **self._guessing(gaps))
        names = (*self.types, new_name(name, self.types, "type"))
        prior = np.append(self.prior * (1 - mass), mass)
        return type(self)(performance, self._signal_for(performance, signal), names, self.policies, prior)

    def with_policy(
        self, samples: ArrayLike, name: str | None = None, *, signal: SignalModel | None = None, gaps: bool = False
    ) -> Self:
        """A library with an additional policy, from its outcomes on every type, `samples` (n_types, n).

        `gaps` as in `with_type`, for types that it has not run on.
        """
        performance = self.performance.with_policy(samples, **self._guessing(gaps))
        names = (*self.policies, new_name(name, self.policies, "policy"))
        return type(self)(performance, self._signal_for(performance, signal), self.types, names, self.prior)

    def without_policy(self, policy: str | int) -> Self:
        """The library without a policy."""
        gone = self.index_of_policy(policy)
        return self.take(policies=[index for index in range(self.n_policies) if index != gone])

    def take(
        self,
        types: Sequence[int] | None = None,
        policies: Sequence[int] | None = None,
        prior: ArrayLike | None = None,
    ) -> Self:
        """A library of some types and policies; by default the prior is renormalised.

        Raises
        ------
        InputError
            No type or policy is left, their prior is 0, or the signal model cannot be restricted.
        """
        performance = self.performance.take(types, policies)
        if isinstance(self.signal, ReturnSignal) and self.signal.outcomes is self.performance:
            signal: Any = ReturnSignal(performance)
        elif (cut := getattr(self.signal, "take", None)) is None:
            raise InputError(
                f"{type(self.signal).__name__} cannot be restricted to some types or policies; build a new library"
            )
        else:
            signal = cut(types, policies)
        chosen, left_policies = chosen_of(types, self.n_types), chosen_of(policies, self.n_policies)
        if prior is None:
            left = self.prior[chosen]
            if not left.sum() > 0:
                raise InputError("the types taken have no prior mass; give prior=")
            prior = left / left.sum()
        names = tuple(self.types[i] for i in chosen), tuple(self.policies[i] for i in left_policies)
        return type(self)(performance, signal, *names, np.asarray(prior))

    def save(self, path: str | Path) -> None:
        """Write the library as one npz file; see `library_file`.

        Raises
        ------
        InputError
            The performance model is not one of this package.
        StoreError
            The disk refuses.
        """
        write_file(path, self.to_bytes(), "the library")

    @classmethod
    def load(cls, path: str | Path, signal: SignalModel | None = None) -> Self:
        """The library that `save` wrote, bit for bit.

        Parameters
        ----------
        signal : SignalModel, optional
            Replaces the file's signal model; required where that was the caller's own.

        Raises
        ------
        InputError
            The file does not exist, is of another kind, newer or damaged.
        """
        return cls.from_bytes(read_file(path, "the library"), str(path), signal)

    def to_bytes(self) -> bytes:
        """The library as the bytes of an npz file; equal libraries give equal bytes."""
        # Imported here: most uses of a library need no file.
        from lifelore.interaction.library.library_file import packed_library

        return packed_library(self)

    @classmethod
    def from_bytes(cls, content: bytes, where: str = "the library", signal: SignalModel | None = None) -> Self:
        """The library of `to_bytes`; `where` names the source in error messages, `signal` is as in `load`."""
        from lifelore.interaction.library.library_file import unpacked_library

        return unpacked_library(content, where, signal, cls)

    def _guessing(self, gaps: bool) -> dict[str, Any]:
        """Options of the outcome model's `with_type` and `with_policy`."""
        if gaps and not isinstance(self.performance, GaussianOutcomes):
            name = type(self.performance).__name__
            raise InputError(f"gaps are guessed by 'gaussian' and 'student-t' models, got {name}; run every pair")
        return {"gaps": True} if gaps else {}

    def _signal_for(self, performance: OutcomeModel, signal: SignalModel | None) -> SignalModel:
        if signal is not None:
            return signal
        if isinstance(self.signal, ReturnSignal) and self.signal.outcomes is self.performance:
            return ReturnSignal(performance)
        raise InputError("signals are not returns here; give the new library's signal model as signal=")
