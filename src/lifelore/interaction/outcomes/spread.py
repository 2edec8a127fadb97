"""The spread of the tasks of a type: how much a pair's mean outcome differs between tasks of the same type.

A library's runs say what a type pays on average. A new task of that type, or a task between two types, pays
something else. With a spread ρ, a pair's mean outcome in a task has the variance ρ v around the mean of its type,
where v is the variance of a single outcome. Runs of a type count for a task as 1 / (1/n + ρ) outcomes of that
task: at ρ = 0 as many as there are, at ρ = 1 less than a single one.

The spread is estimated from the training runs alone. Where these tell the tasks (users) apart, from the variance
between tasks of a type. Otherwise each type in turn takes the part of a task that the other types must explain.
That is the largest spread to be expected, because a real task may be of a known type. So a task holds a belief
over several spreads, from none up to this.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError

Array = NDArray[np.float64]

SHARES = np.array([0.0, 1 / 16, 1 / 4, 1.0])
"""Spreads that a task holds possible, as shares of the largest."""
WEIGHTS = np.array([0.5, 1 / 6, 1 / 6, 1 / 6])
"""Their probabilities before the task: half for a task that is just like its type."""
LEAST_FREEDOM = 30
"""Least comparisons between tasks, and within them, that an analysis of variance needs."""
GRID = np.concatenate([[0.0], np.geomspace(1e-3, 1e3, 25)])
"""Spreads among which the likeliest is looked for."""
NUMBERS = 1 << 21
"""Largest number of (held-out type, type, policy) triples that are compared; more types are sampled evenly."""


class Spread(NamedTuple):
    """Possible spreads and their probabilities before a task.

    values : (n_spreads,) float64, ≥ 0, in units of the variance of one outcome
    weights : (n_spreads,) float64, positive, sum to 1
    """

    values: Array
    weights: Array

    @classmethod
    def known(cls, value: float) -> "Spread":
        """A spread that is not in doubt."""
        return cls(np.array([float(value)]), np.ones(1))

    @classmethod
    def up_to(cls, largest: float) -> "Spread":
        """Several spreads from 0 to the largest; only 0 where that is 0."""
        return cls(SHARES * largest, WEIGHTS.copy()) if largest > 0 else cls.known(0.0)

    @property
    def mean(self) -> float:
        """Expectation of the spread before a task."""
        return float(self.weights @ self.values)

    @property
    def least(self) -> "Spread":
        """The smallest spread alone: that of a task which is just like its type."""
        return Spread.known(self.values.min())

    @classmethod
    def of_array(cls, rows: ArrayLike) -> "Spread":
        """The spread whose values and weights are the rows of (2, n_spreads); InputError for anything else."""
        found = np.array(rows, np.float64)
        if found.ndim != 2 or len(found) != 2 or not found.size or not np.isfinite(found).all():
            raise InputError(f"a spread must be values and weights, (2, n), got shape {found.shape}")
        if (found[0] < 0).any() or (found[1] <= 0).any() or not np.isclose(found[1].sum(), 1):
            raise InputError("a spread's values must be at least 0 and its weights positive, with sum 1")
        return cls(found[0], found[1])


class VarianceAnalysis(NamedTuple):
    """One-way analysis of variance of outcomes of several pairs, within each pair between tasks.

    ratio : F, the variance between tasks' means over that within tasks
    between, within : degrees of freedom
    size : mean number of outcomes of a task with a pair, where these differ as the analysis counts it
    """

    ratio: float
    between: int
    within: int
    size: float

    @property
    def spread(self) -> float:
        """Variance of tasks' means in units of the variance of an outcome, ≥ 0."""
        return max(0.0, (self.ratio - 1) / self.size)

    @property
    def chance(self) -> float:
        """P(F at least as large) of independent normal outcomes whose tasks do not differ."""
        from scipy.special import fdtrc

        return float(fdtrc(self.between, self.within, self.ratio))


def variance_analysis(
    pairs: NDArray[np.int64], tasks: NDArray[np.int64], values: Array, least: int = 1
) -> VarianceAnalysis | None:
    """The analysis of variance between tasks of the same pair.

    Parameters
    ----------
    pairs, tasks : (n,) int
        Number of the pair of type and policy, and of the task, of each outcome.
    values : (n,) float
    least : int
        Number of comparisons between tasks, and within a task, that are needed.

    Returns
    -------
    VarianceAnalysis or None
        None where fewer comparisons are possible, or outcomes within a task never differ.
    """
    n_tasks = int(tasks.max(initial=0)) + 1
    groups, of_group, sizes = np.unique(pairs * n_tasks + tasks, return_inverse=True, return_counts=True)
    _, of_pair, pair_groups = np.unique(groups // n_tasks, return_inverse=True, return_counts=True)
    between, within = int((pair_groups - 1).sum()), len(values) - len(sizes)
    if min(between, within) < least:
        return None
    totals = np.bincount(of_pair, sizes)
    group_means = np.bincount(of_group, values) / sizes
    pair_means = np.bincount(of_pair, sizes * group_means) / totals
    noise = ((values - group_means[of_group]) ** 2).sum() / within
    apart = (sizes * (group_means - pair_means[of_pair]) ** 2).sum() / between
    if not noise > 0:
        return None
    size = (len(values) - (np.bincount(of_pair, sizes**2) / totals).sum()) / between
    return VarianceAnalysis(float(apart / noise), between, within, float(size))


def spread_between(pairs: NDArray[np.int64], tasks: NDArray[np.int64], values: Array) -> Spread | None:
    """The spread by the variance of outcomes between tasks of the same pair, see `variance_analysis`.

    Returns
    -------
    Spread or None
        None where fewer than `LEAST_FREEDOM` comparisons between tasks, or within a task, are possible.
    """
    found = variance_analysis(pairs, tasks, values, LEAST_FREEDOM)
    return None if found is None else Spread.known(found.spread)


def held_out(n_types: int, numbers: int) -> NDArray[np.int64]:
    """The types that take the part of an unknown task: all, or evenly chosen ones where that takes too long.

    `numbers` is how many numbers the comparison of one of them takes.
    """
    n = max(8, min(n_types, NUMBERS // max(1, numbers)))
    return np.unique(np.linspace(0, n_types - 1, n).round().astype(np.int64))


def likeliest(log_likelihoods: Array) -> float:
    """The spread of the grid under which held-out types are likeliest.

    Parameters
    ----------
    log_likelihoods : (n_spreads, n_held_out, n_types) float
        Of each held-out type's runs if it were a task of a type; minus infinity for the type itself.
    """
    top = log_likelihoods.max(axis=2, keepdims=True)
    found = np.log(np.exp(log_likelihoods - top).sum(axis=2)) + top[..., 0]
    return float(GRID[found.sum(axis=1).argmax()])
