"""Measures and rows of claim C3.3."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter3.c3_03_noise_maze_prior.run import COMPARED, KEYS, METHODS, PLAIN, grid_of
from reproduction.engine.curve_blocks import block_edges
from reproduction.engine.estimates import is_above, is_below, share_of
from reproduction.engine.grid import Grid
from reproduction.engine.results_table import BAND, ResultsTable

PAIRS = (("qpap", PLAIN), ("qpap", "qsap"), ("qsap", PLAIN))
"""Compared methods, the first with the second."""


def _table(results: Sequence[Mapping]) -> ResultsTable:
    return ResultsTable.nested(results, "found", keys=("method", *KEYS), outer=("run",))


def _compare(table: ResultsTable, grid: Grid, cell: Mapping) -> dict[str, Estimate]:
    """First returns as differences and episodes to 80 % as ratios, paired by run, in a cell of the grid."""
    compared = {}
    for ours, theirs in PAIRS:
        pair = grid.where(ours, cell), grid.where(theirs, cell)
        compared[f"first_{ours}_minus_{theirs}"] = table.difference("first", *pair)
        compared[f"to_80_ratio_{ours}_to_{theirs}"] = table.ratio("to_80", *pair)
    return compared


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The comparisons at the default, and the shares of the grid in which they come out as the thesis reports."""
    table, grid = _table(results), grid_of(settings)
    compared = [_compare(table, grid, cell) for cell in grid.cells]
    beats_both = [
        all(is_above(c[f"first_qpap_minus_{other}"], 0.0) for other in (PLAIN, "qsap"))
        and all(is_below(c[f"to_80_ratio_qpap_to_{other}"], 1.0) for other in (PLAIN, "qsap"))
        for c in compared
    ]
    worse = [
        is_below(c[f"first_qsap_minus_{PLAIN}"], 0.0) and is_above(c[f"to_80_ratio_qsap_to_{PLAIN}"], 1.0)
        for c in compared
    ]
    return {
        **_compare(table, grid, grid.default),
        "optimal_return": mean_estimate([result["optimal"] for result in results]),
        "grid_qpap_beats_both": share_of(beats_both),
        "grid_qsap_worse": share_of(worse),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The whole grid, a row for each cell, then the curves of the default under each schedule."""
    table, grid = _table(results), grid_of(settings)
    found = []
    for cell in grid.cells:
        row = {**cell, **{name: number.to_dict() for name, number in _compare(table, grid, cell).items()}}
        for method in (PLAIN, *COMPARED):
            where = grid.where(method, cell)
            row[f"to_80_{method}"] = table.mean("to_80", **where).to_dict()
            row[f"never_80_{method}"] = int(table.values("never_80", **where).sum())
            row[f"first_{method}"] = float(np.mean(table.values("first", **where)))
        found.append(row)
    found.append({"curve_edges": block_edges(settings["episodes"]).tolist()})
    for schedule in settings["schedules"]:
        for method in (PLAIN, *METHODS):
            where = grid.where(method, grid.with_schedule(schedule))
            to_80 = table.mean("to_80", **where).to_dict()
            curve = table.curve("curve", parts=BAND, **where)
            found.append({"curve_of": method, "schedule": schedule, "to_80": to_80, **curve})
    return found
