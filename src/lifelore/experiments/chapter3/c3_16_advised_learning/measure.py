"""Measures and rows of claim C3.16."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter3.advice_estimates import at, grid_of, maze_estimate, picked, plain, share_of_grid
from lifelore.experiments.engine.curve_blocks import block_edges


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """At the default: goals found within ten episodes and ever, when, and the reward at the end; the grid."""
    default = settings["default"]
    how = {"starts": default["starts"], "schedule": default["schedule"]}
    cells = at(results, default["loops"])
    columns = {"plain": None, "advised": default["experts"]}
    found = {}
    for key, name in (("in_ten", "found_in_ten"), ("ever", "found_ever"), ("final", "final")):
        alone, told = (_means(cells, how, experts, key) for experts in columns.values())
        found |= {f"{name}_plain": maze_estimate(alone), f"{name}_advised": maze_estimate(told)}
        found[f"{name}_gain"] = maze_estimate(told - alone)
    for name, experts in columns.items():
        firsts = [t["first"] for t in _tasks(cells, how, experts)]
        found[f"first_{name}"] = maze_estimate(_means(cells, how, experts, "first"))
        found[f"median_first_{name}"] = plain(np.median(firsts), len(firsts))
    grid = _grid(settings)
    answers = [_is_handful(at(results, loops), how, experts) for loops, experts, how in grid]
    found["grid_handful"] = share_of_grid(answers)
    return found


def _grid(settings: Mapping) -> list[tuple[float, str, dict]]:
    hows = [{"starts": s, "schedule": e} for s, e in product(settings["starts"], settings["schedules"])]
    return [(loops, experts, how) for how in hows for loops, experts in grid_of(settings)]


def _tasks(cells: Sequence[Mapping], how: Mapping, experts: str | None) -> list[Mapping]:
    return [task for cell in cells for task in picked(cell["learners"], **how, experts=experts)["tasks"]]


def _means(cells: Sequence[Mapping], how: Mapping, experts: str | None, key: str) -> np.ndarray:
    """Each maze's mean over its tasks."""
    return np.array([np.mean([t[key] for t in _tasks([cell], how, experts)]) for cell in cells])


def _is_handful(cells: Sequence[Mapping], how: Mapping, experts: str) -> bool:
    """Whether most tasks' goals are found within ten episodes with advice, and at most 1 of 20 without."""
    told, alone = (_means(cells, how, e, "in_ten").mean() for e in (experts, None))
    return bool(told > 0.5 and alone <= 0.05)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, a row a cell; then the default's curves by starts, with one standard deviation."""
    found = []
    for loops, experts, how in _grid(settings):
        cells = at(results, loops)
        row = {"loops": loops, "experts": experts, **how}
        for name, of in (("plain", None), ("advised", experts)):
            row[name] = {key: round(float(_means(cells, how, of, key).mean()), 3) for key in ("in_ten", "ever")}
            row[name]["final"] = round(float(_means(cells, how, of, "final").mean()), 1)
            row[name]["median_first"] = float(np.median([t["first"] for t in _tasks(cells, how, of)]))
        found.append(row)
    return found + _curves(settings, results)


def _curves(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    default = settings["default"]
    cells = at(results, default["loops"])
    found: list[dict] = [{"curve_edges": block_edges(settings["episodes"]).tolist()}]
    for starts in settings["starts"]:
        for name, experts in (("plain", None), ("advised", default["experts"])):
            how = {"starts": starts, "schedule": default["schedule"], "experts": experts}
            curves = np.array([picked(cell["learners"], **how)["curve"] for cell in cells])
            spread = curves.std(axis=0, ddof=1) if len(curves) > 1 else np.zeros(curves.shape[1])
            mean, spread = (np.round(of, 1).tolist() for of in (curves.mean(axis=0), spread))
            found.append({"curve_of": name, "starts": starts, "mean": mean, "deviation": spread})
    return found
