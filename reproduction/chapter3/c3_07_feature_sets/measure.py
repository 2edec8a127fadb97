"""Measures and rows of claim C3.7."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.factory.contexts import PHI
from reproduction.chapter3.c3_07_feature_sets.run import KEYS, METHODS, PLAIN, STATE, grid_of
from reproduction.engine.estimates import share_of
from reproduction.engine.grid import Cell, Grid
from reproduction.engine.results_table import ResultsTable


def _table(results: Sequence[Mapping]) -> ResultsTable:
    return ResultsTable.nested(results, "found", keys=("method", *KEYS), outer=("run",))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Rewards at the default, the comparisons there, and shares of the grid in the reported order."""
    table, grid = _table(results), grid_of(settings)
    optimal = np.array([result["optimal"] for result in results])
    at = {method: grid.where(method, grid.default) for method in METHODS}
    measured = {"optimal_reward": mean_estimate(optimal)}
    measured |= {f"early_{method}": table.mean("early", **at[method]) for method in METHODS}
    pairs = [("phi3", "phi1"), ("phi3", "phi2"), ("phi4", "phi3"), (STATE, PLAIN), *((phi, STATE) for phi in PHI)]
    for ours, theirs in pairs:
        measured[f"{ours}_minus_{theirs}"] = table.difference("all", at[ours], at[theirs])
    every = {method: table.values("all", **at[method]) for method in METHODS}
    measured["phi2_minus_phi3_of_distance"] = ratio_estimate(every["phi2"] - every["phi3"], optimal - every[PLAIN])
    size = np.abs([_of_walls(settings, result, grid.default) for result in results]).mean(axis=1)
    measured["optimal_size"] = mean_estimate(size)
    measured["phi2_minus_phi3_of_optimal"] = ratio_estimate(every["phi2"] - every["phi3"], size)
    return {**measured, **_shares_of_the_grid(table, grid)}


def _shares_of_the_grid(table: ResultsTable, grid: Grid) -> dict[str, Estimate]:
    """Shares of cells in the reported order: with the default number of walls, and with walls crossed."""
    means = [(cell, _means(table, grid, cell)) for cell in grid.cells]
    first = [mean for cell, mean in means if cell["walls"] == grid.default["walls"]]
    # Only the prior over states reads the code of a state: the sets of features meet one cell under every code.
    distinct = [mean for cell, mean in means if cell["encoding"] == grid.default["encoding"]]
    return {
        "grid_features_above_state_above_uniform": share_of([_is_in_order(mean) for mean in first]),
        "grid_phi3_best": share_of([_is_phi3_best(mean) for mean in first]),
        "walls_grid_features_above_state_above_uniform": share_of([_is_in_order(mean) for _, mean in means]),
        "walls_grid_phi3_best": share_of([_is_phi3_best(mean) for mean in distinct]),
    }


def _means(table: ResultsTable, grid: Grid, cell: Cell) -> dict[str, float]:
    """Each method's mean reward of an episode in a cell."""
    return {method: float(table.values("all", **grid.where(method, cell)).mean()) for method in METHODS}


def _is_in_order(mean: Mapping[str, float]) -> bool:
    """Whether every set of features earns more than states, and states more than no prior."""
    return min(mean[phi] for phi in PHI) > mean[STATE] > mean[PLAIN]


def _is_phi3_best(mean: Mapping[str, float]) -> bool:
    """Whether φ3 earns most of the four sets."""
    return max(mean[phi] for phi in PHI) == mean["phi3"]


def _of_walls(settings: Mapping, result: Mapping, cell: Mapping) -> list[float]:
    """The optimal rewards of the test tasks of a cell's layouts."""
    return result["optimal_of_walls"][settings["walls"].index(cell["walls"])]


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The whole grid, a row for each cell, then the curves of the default under every schedule."""
    table, grid = _table(results), grid_of(settings)
    found = []
    for cell in grid.cells:
        optimal = np.array([np.mean(_of_walls(settings, result, cell)) for result in results])
        every = {method: table.values("all", **grid.where(method, cell)) for method in METHODS}
        row = {**cell, **{f"all_{method}": float(values.mean()) for method, values in every.items()}}
        for method in METHODS[1:]:
            closed = ratio_estimate(every[method] - every[PLAIN], optimal - every[PLAIN])
            row[f"closed_{method}"] = closed.to_dict()
        found.append(row)
    for schedule in settings["schedules"]:
        for method in METHODS:
            where = grid.where(method, grid.with_schedule(schedule))
            curve = table.curve("mean", digits=2, parts=("mean", "deviation"), **where)
            found.append({"curve_of": method, "schedule": schedule, **curve})
    return found
