"""Measures and rows of claim C3.16."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter3.advice.mazes import grid_of, grid_share, maze_estimate
from lifelore.experiments.engine.curve_blocks import block_edges
from lifelore.experiments.engine.results_table import ResultsTable


def _table(results: Sequence[Mapping]) -> ResultsTable:
    return ResultsTable.nested(results, "learners", ("experts", "starts", "schedule"), ("loops",))


def _cells(settings: Mapping) -> list[dict]:
    """The grid: starts and schedules, each with every loop density and kind of experts."""
    return [
        {"loops": loops, "experts": experts, "starts": starts, "schedule": schedule}
        for starts, schedule in product(settings["starts"], settings["schedules"])
        for loops, experts in grid_of(settings)
    ]


def _by_maze(table: ResultsTable, measure: str, cell: Mapping, advised: bool) -> np.ndarray:
    """Each maze's mean over its tasks."""
    experts = cell["experts"] if advised else None
    return table.values(measure, **{**cell, "experts": experts}).mean(axis=1)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """At the default: goals found within ten episodes and ever, and the reward at the end; the grid."""
    table, default, found = _table(results), settings["default"], {}
    for measure, name in (("in_ten", "found_in_ten"), ("ever", "found_ever"), ("final", "final")):
        plain, advised = (_by_maze(table, measure, default, with_advice) for with_advice in (False, True))
        found |= {f"{name}_plain": maze_estimate(plain), f"{name}_advised": maze_estimate(advised)}
        found[f"{name}_gain"] = maze_estimate(advised - plain)
    return found | {"grid_handful": grid_share([_is_handful(table, cell) for cell in _cells(settings)])}


def _is_handful(table: ResultsTable, cell: Mapping) -> bool:
    """Whether most tasks' goals are found within ten episodes with advice, and at most 1 of 20 without."""
    plain, advised = (_by_maze(table, "in_ten", cell, with_advice).mean() for with_advice in (False, True))
    return bool(advised > 0.5 and plain <= 0.05)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, a row a cell; then the default's curves by starts, with one standard deviation."""
    table, default, found = _table(results), settings["default"], []
    for cell in _cells(settings):
        row: dict = dict(cell)
        for name, advised in (("plain", False), ("advised", True)):
            means = {key: float(_by_maze(table, key, cell, advised).mean()) for key in ("in_ten", "ever", "final")}
            row[name] = {key: round(mean, 1 if key == "final" else 3) for key, mean in means.items()}
            firsts = table.values("first", **{**cell, "experts": cell["experts"] if advised else None})
            row[name]["median_first"] = float(np.median(firsts))
        found.append(row)
    found.append({"curve_edges": block_edges(settings["episodes"]).tolist()})
    for starts in settings["starts"]:
        for name, experts in (("plain", None), ("advised", default["experts"])):
            curve = table.curve("curve", 1, **{**default, "starts": starts, "experts": experts})
            found.append({"curve_of": name, "starts": starts} | {key: curve[key] for key in ("mean", "deviation")})
    return found
