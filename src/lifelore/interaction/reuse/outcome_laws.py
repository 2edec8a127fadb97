"""Laws of outcomes that are known from a finite number of runs, as the kernels for many users read them.

Given a type, a pair's outcomes have unknown parameters. What the library's runs leave open about them is a
normal-inverse-χ² law of mean and variance (see `task_normals`), or a Dirichlet law of the probabilities of cells
(see `dirichlet`). After a user's outcomes the law is of the same kind. Runs count as κ₀ = 1 / (1/n + ρ) outcomes
of a user, ρ the spread of the users of a type.
"""

from functools import cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.batch_likelihood import finite_signals
from lifelore.interaction.outcomes.counted_outcomes import CountedOutcomes
from lifelore.interaction.outcomes.moment_outcomes import MomentOutcomes
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.outcomes.task_counts import TaskCounts
from lifelore.interaction.outcomes.task_normals import TaskNormals
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

EXACT = 1e30
"""Degrees of freedom of a variance that is known exactly: t is then normal to the last digit."""
LEAST_FREEDOM = 1e-6
"""Least degrees of freedom; fewer would leave the range of numbers."""


class Shown(NamedTuple):
    """The chunks of all users, see `user_outcome_kernels`.

    heads, sizes : (capacity,) int32
    real : (n_chunks, WORDS) float64
    whole : (n_chunks, 2 WORDS) int32, the same memory
    state : (3,) int64
    """

    heads: NDArray[np.int32]
    sizes: NDArray[np.int32]
    real: Array
    whole: NDArray[np.int32]
    state: Numbers


class Tried(NamedTuple):
    """The policies that some users tried, one user after another.

    starts : (k + 1,) int64, where each user's begin
    policies : (m,) int64
    counts, averages : (m,) float64, number and mean of the outcomes
    """

    starts: Numbers
    policies: Numbers
    counts: Array
    averages: Array


class NormalLaw:
    """The law of Gaussian and Student's t outcomes.

    Parameters
    ----------
    moments : OutcomeMoments
        Read once.
    spread : float
        ρ, at least 0.

    Attributes
    ----------
    mean, doubt : (n_types, n_policies) float64
        m₀ and 1 / κ₀.
    spread : float
    groups : int
        Groups of `n_slots` numbers in a chunk.
    """

    groups = 3

    def __init__(self, moments: OutcomeMoments, spread: float) -> None:
        self.spread = spread
        self.mean: Array = np.array(moments.mean)
        self.doubt: Array = 1 / moments.count + spread
        freedom = np.clip(moments.freedom, LEAST_FREEDOM, EXACT)
        self._centre, self._doubt = np.ascontiguousarray(self.mean.T), np.ascontiguousarray(self.doubt.T)
        self._weight = np.ascontiguousarray((freedom * moments.variance).T)
        self._half = np.ascontiguousarray(0.5 * freedom.T)
        scale = self._weight * (1 + self._doubt)
        self._narrow, self._top = 1 / scale, np.empty_like(scale)
        _kernels().student_tops(self._half, scale, self._top)
        same = (self._doubt == self._doubt[:, :1]) & (self._half == self._half[:, :1])
        self._alike = same.all(axis=1)

    @property
    def n_slots(self) -> int:
        """Number of policies in a chunk."""
        return _kernels().SLOTS

    @property
    def n_keys(self) -> int:
        """Number of policies."""
        return self.mean.shape[1]

    def checked(self, signals: ArrayLike) -> Array:
        """Finite numbers (k,)."""
        return finite_signals(signals)

    def write(
        self, shown: Shown, users: Numbers, policies: Numbers, signals: Array, out: Array, adds: bool = True
    ) -> None:
        """Write log densities (k, n_types) given what each user has shown, and add the signals, in order."""
        _kernels().student_rows(
            adds, users, policies, signals, *shown, self._centre, self._doubt, self._weight, self._half,
            self._narrow, self._top, self._alike, out,
        )  # fmt: skip

    def write_new(self, policies: Numbers, signals: Array, out: Array) -> None:
        """Write log densities (k, n_types) of users who have shown nothing."""
        _kernels().new_student_rows(policies, signals, self._centre, self._half, self._narrow, self._top, out)

    def add(self, shown: Shown, users: Numbers, policies: Numbers, signals: Array, keeps: Array) -> None:
        """Let what each user has shown count `keeps` (k,) of what it did, then add a signal; nothing where NaN."""
        _kernels().add_moments(users, policies, signals, keeps, *shown)

    def tried(self, shown: Shown, users: Numbers) -> Tried:
        """The policies that `users` tried."""
        tried = _room_for(shown, users)
        _kernels().tried_moments(users, *shown[:4], *tried)
        return tried

    def task(self, library: PolicyLibrary, keys: Numbers, numbers: Array) -> TaskNormals:
        """The outcomes of a library's policies as a single user shows them.

        Parameters
        ----------
        library : PolicyLibrary
        keys : (m,) int64
            Its policies that the user tried.
        numbers : (m, groups) float64
            Their slots.
        """
        model = TaskNormals(library.performance.moments, Spread.known(self.spread))  # pyright: ignore
        model.restore({"policies": keys, "shown": numbers, "log_weights": np.zeros(1)})
        return model


class CountedLaw:
    """The law of histogram and categorical outcomes; see `NormalLaw`."""

    groups = 1

    def __init__(self, model: CountedOutcomes, spread: float) -> None:
        self.spread, self._model = spread, model
        self._totals: Array = 1 / (1 / model.totals + spread)
        prior = model.counts * (self._totals / model.totals)[:, :, None]
        self._prior = np.ascontiguousarray(prior.transpose(0, 2, 1))
        self._log_sizes, self._means = np.log(model.cell_sizes), np.array(model.cell_means, np.float64)
        self.mean: Array = np.array(model.mean)
        self.doubt: Array = np.ascontiguousarray(1 / self._totals.T)

    @property
    def n_slots(self) -> int:
        """Number of cells in a chunk."""
        return _kernels().CELLS

    @property
    def n_keys(self) -> int:
        """Number of pairs of a policy and a cell."""
        return self.mean.shape[1] * len(self._means)

    def checked(self, signals: ArrayLike) -> Array:
        """Finite numbers (k,)."""
        return finite_signals(signals)

    def write(
        self, shown: Shown, users: Numbers, policies: Numbers, signals: Array, out: Array, adds: bool = True
    ) -> None:
        """Write log densities (k, n_types) given what each user has shown, and add the signals, in order."""
        cells = self._model.cells_of(signals)
        _kernels().counted_rows(
            adds, users, policies, cells, *shown, self._prior, self._totals, self._log_sizes, out
        )

    def write_new(self, policies: Numbers, signals: Array, out: Array) -> None:
        """Write log densities (k, n_types) of users who have shown nothing."""
        cells = self._model.cells_of(signals)
        _kernels().new_counted_rows(policies, cells, self._prior, self._totals, self._log_sizes, out)

    def add(self, shown: Shown, users: Numbers, policies: Numbers, signals: Array, keeps: Array) -> None:
        """Let what each user has shown count `keeps` (k,) of what it did, then add a signal; nothing where NaN."""
        cells = self._model.cells_of(signals)
        _kernels().add_counts(users, policies, cells, keeps, len(self._means), *shown)

    def tried(self, shown: Shown, users: Numbers) -> Tried:
        """The policies that `users` tried."""
        tried = _room_for(shown, users)
        _kernels().tried_counts(users, *shown[:4], self._means, self.mean.shape[1], *tried)
        n = int(tried.starts[-1])
        return Tried(tried.starts, tried.policies[:n], tried.counts[:n], tried.averages[:n])

    def task(self, library: PolicyLibrary, keys: Numbers, numbers: Array) -> TaskCounts:
        """The outcomes of a library's policies as a single user shows them; keys are policies and cells."""
        n_cells = len(self._means)
        policies, place = np.unique(keys // n_cells, return_inverse=True)
        shown = np.zeros((len(policies), n_cells))
        shown[place, keys % n_cells] = numbers[:, 0]
        model = TaskCounts(library.performance, Spread.known(self.spread))  # pyright: ignore[reportArgumentType]
        model.restore({"policies": policies, "shown": shown, "log_weights": np.zeros(1)})
        return model


OutcomeLaw = NormalLaw | CountedLaw


def outcome_law(library: PolicyLibrary, spread: float | None = None) -> OutcomeLaw | None:
    """The law of the library's outcomes; None where all are exact, or the signal is not the return.

    `spread` is ρ, by default the mean of the spreads that the library holds possible.
    """
    model: Any = library.performance
    if type(library.signal) is not ReturnSignal or library.signal.outcomes is not model:
        return None
    if not isinstance(model, MomentOutcomes | CountedOutcomes) or model.for_task() is None:
        return None
    if spread is None:
        spread = float(model.spread.weights @ model.spread.values)
    return NormalLaw(model.moments, spread) if isinstance(model, MomentOutcomes) else CountedLaw(model, spread)


def _room_for(shown: Shown, users: Numbers) -> Tried:
    most = int(shown.sizes[users].sum())
    return Tried(np.empty(len(users) + 1, np.int64), np.empty(most, np.int64), np.empty(most), np.empty(most))


@cache
def _kernels() -> ModuleType:
    # Imported at the first use: the import starts Numba.
    from lifelore.interaction.reuse import user_outcome_kernels

    return user_outcome_kernels
