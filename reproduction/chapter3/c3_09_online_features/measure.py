"""Measures and rows of claim C3.9."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate, ratio_estimate
from reproduction.chapter3.c3_09_online_features.run import (
    ASKED,
    KEYS,
    METHODS,
    OF_E4,
    first_grid_of,
    grid_of,
)
from reproduction.chapter3.factory.online_selection import FULL, SELECTED, UNIFORM
from reproduction.engine.curve_blocks import block_edges
from reproduction.engine.estimates import share_of
from reproduction.engine.grid import Grid
from reproduction.engine.results_table import ResultsTable

PARTS = ("first", "last")
PAIRS = ((SELECTED, FULL), (FULL, UNIFORM), (SELECTED, UNIFORM))
ALIKE = 0.05
"""Largest difference of alike methods, as a share of the optimal reward's size."""


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
    return {**measured, **_of_optimal(settings, results), **_shares_of_the_grid(settings, results)}


def _shares_of_the_grid(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of cells in the reported order at first, and alike in the last episode and when learnt on."""
    table, grid = _table(results), grid_of(settings)
    size, long_size = (float(sizes.mean()) for sizes in _optimal_sizes(settings, results))

    def in_order(cell: Mapping) -> bool:
        mean = {method: float(x.mean()) for method, x in _means(settings, table, cell, "first").items()}
        return mean[SELECTED] >= mean[FULL] > mean[UNIFORM]

    def alike_at_last(cell: Mapping) -> bool:
        means = [float(x.mean()) for x in _means(settings, table, cell, "last").values()]
        return max(means) - min(means) <= ALIKE * size

    def alike_at_end(source: str) -> bool:
        losses = [float(x.mean()) for x in _losses_at_end(table, grid, source).values()]
        return max(losses) - min(losses) <= ALIKE * long_size

    return {
        "grid_order_at_first": share_of([in_order(cell) for cell in first_grid_of(settings).cells]),
        "crossed_grid_order_at_first": share_of([in_order(cell) for cell in grid.cells]),
        "crossed_grid_alike_at_last": share_of([alike_at_last(cell) for cell in grid.cells]),
        "sources_alike_at_end": share_of([alike_at_end(source) for source in settings["sources"]]),
    }


def _losses_at_end(table: ResultsTable, grid: Grid, source: str) -> dict[str, NDArray[np.float64]]:
    """Each method's reward below the optimum when learnt on, at a source's default, (n_runs,)."""
    cell = {**grid.default, "source": source}
    return {method: table.values("loss_at_end", **grid.where(method, cell)) for method in METHODS}


def _optimal_sizes(
    settings: Mapping, results: Sequence[Mapping]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Sizes of the optimal reward over the tasks after the first and over those learnt on, (n_runs,) each."""
    sizes = np.abs([result["optimal"] for result in results])
    return sizes[:, 1:].mean(axis=1), sizes[:, -settings["long_tasks"] :].mean(axis=1)


def _of_optimal(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Differences after the last episode and when learnt on, as shares of the optimal reward's size.

    The size of an optimal reward is its absolute value: its moves cost about what the task pays, so that it is
    above zero in some tasks and below in others.
    """
    table, grid = _table(results), grid_of(settings)
    size, long_size = _optimal_sizes(settings, results)
    measured = {"optimal_size": mean_estimate(size)}
    for source in settings["sources"]:
        name_of, cell = source.replace(", ", "_"), {**grid.default, "source": source}
        if source == OF_E4:
            first = _means(settings, table, cell, "first")
            for ours, theirs in PAIRS:
                difference = difference_estimate(first[ours], first[theirs])
                measured[f"{name_of}_first_{ours}_minus_{theirs}"] = difference
        last = _means(settings, table, cell, "last")
        loss = _losses_at_end(table, grid, source)
        for ours, theirs in PAIRS:
            name = f"{ours}_minus_{theirs}_of_optimal"
            measured[f"{name_of}_last_{name}"] = ratio_estimate(last[ours] - last[theirs], size)
            measured[f"{name_of}_end_{name}"] = ratio_estimate(loss[theirs] - loss[ours], long_size)
        for method in METHODS:
            measured[f"{name_of}_end_{method}_below_optimal"] = ratio_estimate(loss[method], long_size)
    return measured


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, a row for each cell, then the default's curves over tasks by source."""
    table, grid = _table(results), grid_of(settings)
    optimal = np.array([np.mean(result["optimal"][1:]) for result in results])
    found: list[dict] = [_row(settings, table, cell, optimal) for cell in grid.cells]
    for source in settings["sources"]:
        for method in METHODS:
            where = grid.where(method, {**grid.default, "source": source})
            for part in PARTS:
                curve = table.curve(part, digits=2, parts=("mean", "deviation"), **where)
                found.append({"curve_of": method, "of_source": source, "part": part, **curve})
    found.append({"curve_edges": block_edges(settings["long_episodes"]).tolist()})
    for source in settings["sources"]:
        for method in METHODS:
            where = grid.where(method, {**grid.default, "source": source})
            found.append({"loss_of": method, "loss_source": source, **table.curve("loss", 2, ("mean",), **where)})
    return found


def _row(settings: Mapping, table: ResultsTable, cell: Mapping, optimal: NDArray[np.float64]) -> dict:
    """A cell's rewards, and differences as shares of the distance from no prior at first to the optimum."""
    of_part = {part: _means(settings, table, cell, part) for part in PARTS}
    row, distance = dict(cell), optimal - of_part["first"][UNIFORM]
    for part, rewards in of_part.items():
        row |= {f"{part}_{method}": float(values.mean()) for method, values in rewards.items()}
        for ours, theirs in PAIRS:
            difference = ratio_estimate(rewards[ours] - rewards[theirs], distance)
            row[f"{part}_{ours}_minus_{theirs}_of_distance"] = difference.to_dict()
    return row
