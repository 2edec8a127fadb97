"""Measures and rows of claim C3.9."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter3.c3_09_online_features.run import ASKED, KEYS, METHODS, grid_of
from lifelore.experiments.chapter3.factory.online_selection import FULL, SELECTED, UNIFORM
from lifelore.experiments.engine.estimates import share_of
from lifelore.experiments.engine.results_table import ResultsTable

PARTS = ("first", "last")
PAIRS = ((SELECTED, FULL), (FULL, UNIFORM), (SELECTED, UNIFORM))


def _table(results: Sequence[Mapping]) -> ResultsTable:
    return ResultsTable.nested(results, "found", keys=("method", *KEYS), outer=("run",))


def _means(settings: Mapping, table: ResultsTable, cell: Mapping, part: str) -> dict[str, NDArray[np.float64]]:
    """Each method's mean reward over the tasks after the first, (n_runs,)."""
    grid = grid_of(settings)
    return {m: table.values(part, **grid.where(m, cell))[:, 1:].mean(axis=1) for m in METHODS}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Paired differences between methods for each source of policies, and the share of the grid in their order."""
    table, grid = _table(results), grid_of(settings)
    optimal = np.array([np.mean(result["optimal"][1:]) for result in results])
    measured = {"optimal_reward": mean_estimate(optimal)}
    for source in ASKED:
        cell = {**grid.default, "source": source}
        first, last = (_means(settings, table, cell, part) for part in PARTS)
        for ours, theirs in PAIRS:
            name = f"{ours}_minus_{theirs}"
            measured[f"{source}_first_{name}"] = difference_estimate(first[ours], first[theirs])
            of_distance = ratio_estimate(last[ours] - last[theirs], optimal - first[UNIFORM])
            measured[f"{source}_last_{name}_of_distance"] = of_distance
        features = table.values("n_features", **grid.where(SELECTED, cell))[:, -1]
        measured[f"{source}_features_after_last_task"] = mean_estimate(features)
    ordered = []
    for cell in grid.cells:
        mean = {method: float(x.mean()) for method, x in _means(settings, table, cell, "first").items()}
        ordered.append(mean[SELECTED] >= mean[FULL] > mean[UNIFORM])
    return {**measured, "grid_order_at_first": share_of(ordered)}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, a row for each cell, then the default's curves over tasks by source."""
    table, grid = _table(results), grid_of(settings)
    found = []
    for cell in grid.cells:
        row = dict(cell)
        for part in PARTS:
            every = _means(settings, table, cell, part)
            row |= {f"{part}_{method}": float(values.mean()) for method, values in every.items()}
            difference = difference_estimate(every[SELECTED], every[FULL])
            row[f"{part}_selected_minus_full"] = difference.to_dict()
        found.append(row)
    for source in settings["sources"]:
        for method in METHODS:
            where = grid.where(method, {**grid.default, "source": source})
            for part in PARTS:
                curve = table.curve(part, digits=2, parts=("mean", "deviation"), **where)
                found.append({"curve_of": method, "of_source": source, "part": part, **curve})
    return found
