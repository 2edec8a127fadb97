"""Measures and rows of claim C3.16."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate
from reproduction.chapter3.advice.buildings import name_of, other_choices
from reproduction.chapter3.advice.mazes import grid_of, grid_share, maze_estimate
from reproduction.engine.curve_blocks import block_edges
from reproduction.engine.results_table import ResultsTable


def _table(results: Sequence[Mapping]) -> ResultsTable:
    results = [result for result in results if "learners" in result]
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
    handful = [_is_handful(table, cell) for cell in _cells(settings)]
    one_start, others = _of_buildings(settings, results)
    return (
        found | {"grid_handful": grid_share(handful), "crossed_handful": grid_share(handful + others)} | one_start
    )


def _is_handful(table: ResultsTable, cell: Mapping) -> bool:
    """Whether most tasks' goals are found within ten episodes with advice, and at most 1 of 20 without."""
    plain, advised = (_by_maze(table, "in_ten", cell, with_advice).mean() for with_advice in (False, True))
    return _as_claimed(plain, advised)


def _as_claimed(plain: float, advised: float) -> bool:
    return bool(advised > 0.5 and plain <= 0.05)


def _beside(results: Sequence[Mapping]) -> ResultsTable:
    results = [result for result in results if "beside" in result]
    return ResultsTable.nested(results, "beside", ("alpha0",), ("building", "maze"))


def _of_buildings(settings: Mapping, results: Sequence[Mapping]) -> tuple[dict[str, Estimate], list[bool]]:
    """The default with the explorers' starts, goals found in ten in every building, and where else it holds."""
    table, found, others = _beside(results), {}, []

    def by_maze(measure: str, place: int, alpha0: float | None) -> np.ndarray:
        return table.values(measure, building=place, alpha0=alpha0).mean(axis=1)

    for measure, name in (("in_ten", "found_in_ten"), ("final", "final")):
        plain, advised = by_maze(measure, 0, None), by_maze(measure, 0, 0.0)
        found |= {f"one_start_{name}_plain": maze_estimate(plain)}
        found |= {f"one_start_{name}_advised": maze_estimate(advised)}
        found |= {f"one_start_{name}_gain": maze_estimate(advised - plain)}
    for place, building in enumerate(settings["buildings"]):
        for name, alpha0 in (("plain", None), ("advised", 0.0)):
            found[f"{name_of(building)}_in_ten_{name}"] = maze_estimate(by_maze("in_ten", place, alpha0))
    for place, alpha0 in other_choices(settings):
        others.append(_as_claimed(by_maze("in_ten", place, None).mean(), by_maze("in_ten", place, alpha0).mean()))
    return found, others


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
    beside = _beside(results)
    plain = [(place, None) for place in range(len(settings["buildings"]))]
    for place, alpha0 in [*plain, (0, 0.0), *other_choices(settings)]:
        numbers = {key: beside.values(key, building=place, alpha0=alpha0) for key in ("in_ten", "ever", "final")}
        means = {key: round(float(values.mean()), 3) for key, values in numbers.items()}
        found.append({"building": settings["buildings"][place], "alpha0": alpha0, **means})
    return found
