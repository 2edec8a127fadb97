"""Rewards of learners with and without priors, compared over the choices that the thesis leaves open.

The unit of every comparison is the distance from learning without a prior to the optimum: an optimal episode's
moves cost about what its task pays, so that the optimal reward itself lies near 0 and is no scale.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.learning.curve import Curve
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from reproduction.engine.grid import Cell, Grid
from reproduction.engine.records import curve_of, having, in_blocks, nested, values_of

UNIFORM = "uniform"
"""Q-learning without a prior."""

Pairs = Mapping[str, tuple[str, ...]]
"""Name of a measure → the two methods compared, and the rewards: ``all`` unless it names others."""


def grid_of(
    settings: Mapping,
    crossed: Sequence[str],
    singly: Sequence[str] = (),
    reads: Mapping[str, Sequence[str]] | None = None,
) -> Grid:
    """`Grid.crossed`, where `UNIFORM` reads what a learner without a prior reads."""
    return Grid.crossed(
        settings, crossed, singly, {UNIFORM: ("schedule", "max_steps", "episodes"), **(reads or {})}
    )


def is_default(grid: Grid, cell: Mapping, but: Sequence[str] = ()) -> bool:
    """Whether a cell, as any method meets it, is the default in all choices `but` some."""
    return all(cell[key] in (None, value) for key, value in grid.default.items() if key not in but)


def summary(curves: Sequence[Curve], early: int, drawn: bool) -> dict:
    """A run's numbers from the curves of its tasks.

    Returns mean rewards of ``all`` and of the first `early` episodes; the ``spread`` of these, the standard
    deviation across tasks (with several tasks); and, if `drawn`, the ``rewards`` in even blocks of episodes,
    (n_tasks, at most `POINTS`).
    """
    rewards = np.array([curve.rewards for curve in curves])
    first = rewards[:, :early]
    found = {"all": float(rewards.mean()), "early": float(first.mean())}
    if len(curves) > 1:
        found["spread"] = float(first.std(axis=0, ddof=1).mean())
    return {**found, "rewards": in_blocks(rewards).tolist()} if drawn else found


class Comparison:
    """The records of every method in every cell of a grid, run by run; each result has its ``optimal`` reward."""

    def __init__(self, results: Sequence[Mapping], grid: Grid) -> None:
        self.grid, self.results = grid, results
        self.records = nested(results, "found")
        self.optimal = np.array([result["optimal"] for result in results], float)

    def values(self, method: str, cell: Mapping, number: str = "all") -> NDArray[np.float64]:
        """A number of a method, run by run."""
        return values_of(self.records, number, **self.grid.where(method, cell))

    def distance(self, cell: Mapping, number: str = "all") -> NDArray[np.float64]:
        """From learning without a prior to the optimum, run by run."""
        return self.optimal - self.values(UNIFORM, cell, number)

    def share(self, cell: Mapping, ours: str, theirs: str, number: str = "all") -> Estimate:
        """Our reward less theirs, as a share of the distance from no prior to the optimum."""
        difference = self.values(ours, cell, number) - self.values(theirs, cell, number)
        return ratio_estimate(difference, self.distance(cell, number))

    def shares(self, cell: Mapping, pairs: Pairs) -> dict[str, Estimate]:
        """`share` of each pair for which the cell is a reading of its own."""
        return {name: self.share(cell, *pair) for name, pair in pairs.items() if self.is_own(cell, *pair[:2])}

    def is_own(self, cell: Mapping, *methods: str) -> bool:
        """Whether a cell differs from the default in nothing but what one of the methods reads."""
        read = {key for method in methods for key in self.grid.reads.get(method, self.grid.default)}
        return all(cell[key] == value for key, value in self.grid.default.items() if key not in read)

    def curve(self, method: str, cell: Mapping) -> dict:
        """A row with a method's ``mean`` rewards and their standard ``deviation`` across the tasks of all runs."""
        records = having(self.records, **self.grid.where(method, cell))
        curves = [of_task for record in records for of_task in record["rewards"]]
        return {"curve_of": method, **curve_of(curves)}


def functions_of(
    grid_of: Callable[[Mapping], Grid], methods: Sequence[str], numbers: Callable[[Comparison, Mapping], dict]
) -> tuple[Callable, Callable, Callable]:
    """The functions ``measure``, ``readings`` and ``rows`` of a claim that compares `methods` over a grid.

    ``numbers(found, cell)`` are its estimates in a cell; beside them is the optimal reward, and the row of each
    method is its curve at the default.
    """

    def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
        return {"optimal_reward": mean_estimate([result["optimal"] for result in results])}

    def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[Cell, dict[str, Estimate]]]:
        found = Comparison(results, grid_of(settings))
        return ((cell, numbers(found, cell)) for cell in found.grid.cells)

    def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
        found = Comparison(results, grid_of(settings))
        return [found.curve(method, found.grid.default) for method in methods]

    return measure, readings, rows
