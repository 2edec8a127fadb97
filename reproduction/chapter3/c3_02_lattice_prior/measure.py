"""Measures and rows of claim C3.2."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter3.c3_02_lattice_prior.run import (
    CROSSED_KEYS,
    KEYS,
    PLAIN,
    annealed,
    configurations,
    crossed_choices,
    without_ties,
)
from reproduction.engine.curve_blocks import block_edges
from reproduction.engine.estimates import is_above, is_below, share_of
from reproduction.engine.results_table import BAND, ResultsTable


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The headline at the default, the shares of the grid, and the online series."""
    table, default = _table(results), settings["default"]
    at_default = [r["optimal"] for r in results if r["kind"] == "grid" and r["schedule"] == default["schedule"]]
    prior, plain = (_where(default["schedule"], how) for how in (default, PLAIN))
    return {
        "first_eps_qsap": table.mean("first", **prior),
        "to_80_ratio": table.ratio("to_80", prior, plain),
        "optimal_return": mean_estimate(at_default),
        **_grid_shares(settings, table),
        **_crossed_measures(settings, results),
        **_online_measures(settings, [r for r in results if r["kind"] == "online"]),
    }


def _table(results: Sequence[Mapping]) -> ResultsTable:
    grid = [result for result in results if result["kind"] == "grid"]
    return ResultsTable.nested(grid, "methods", keys=KEYS, outer=("schedule", "run"))


def _where(schedule: Sequence[float], how: Mapping) -> dict:
    return {"schedule": schedule, **{key: how[key] for key in KEYS}}


def _grid_shares(settings: Mapping, table: ResultsTable) -> dict[str, Estimate]:
    """Shares of the grid's cells in which the two halves of the claim hold, each by its interval."""
    cells = [(s, how) for s in settings["schedules"] for how in configurations(settings)]
    positive = [is_above(table.mean("first", **_where(*cell)), 0.0) for cell in cells]
    faster = [is_below(table.ratio("to_80", _where(*cell), _where(cell[0], PLAIN)), 1.0) for cell in cells]
    return {
        "grid_positive_at_once": share_of(positive),
        "grid_faster_to_80": share_of(faster),
        "grid_both": share_of(np.logical_and(positive, faster)),
    }


def _crossed_table(results: Sequence[Mapping], runs: int) -> ResultsTable:
    """Choices of learning in the first `runs`; from ``crossed_runs`` on only the default with α annealed."""
    crossed = [result for result in results if result["kind"] == "crossed" and result["run"] < runs]
    return ResultsTable.nested(crossed, "methods", keys=CROSSED_KEYS, outer=("run",))


def _crossed_measures(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The headline with α annealed, and the shares of all cells: the grid's and those of choices of learning."""
    table, printed = _table(results), annealed(settings)
    every, crossed = (_crossed_table(results, settings[runs]) for runs in ("runs", "crossed_runs"))
    firsts, ratios = [], []
    for schedule, how in product(settings["schedules"], configurations(settings)):
        where = _where(schedule, how)
        firsts.append(table.mean("first", **where))
        ratios.append(table.ratio("to_80", where, _where(schedule, PLAIN)))
    for choice in crossed_choices(settings):
        firsts.append(crossed.mean("first", **choice))
        ratios.append(crossed.ratio("to_80", choice, without_ties(choice)))
    positive, faster = [is_above(x, 0.0) for x in firsts], [is_below(x, 1.0) for x in ratios]
    return {
        "annealed_first_eps_qsap": every.mean("first", **printed),
        "annealed_to_80_ratio": every.ratio("to_80", printed, without_ties(printed)),
        "crossed_positive_at_once": share_of(positive),
        "crossed_faster_to_80": share_of(faster),
        "crossed_both": share_of(np.logical_and(positive, faster)),
    }


def _online_measures(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    plain, optimal = (np.array([r[key] for r in results]) for key in ("plain", "optimal"))
    keys = list(product(("learnt", "exact"), settings["online_tasks"]))
    gain = {(s, n): np.array([r["first_ten"][f"{s}_{n}"] for r in results]) - plain for s, n in keys}
    n_tasks = settings["training_tasks"]
    beyond_exact = (gain["learnt", n_tasks] - gain["exact", n_tasks]) / optimal
    return {
        **{f"online_gain_after_{n}_{source}": mean_estimate(g) for (source, n), g in gain.items()},
        "online_minus_exact_of_optimal": mean_estimate(beyond_exact),
        "q_learning_is_uniform_prior": mean_estimate([float(r["same"]) for r in results]),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The whole grid, a row for each cell, then the curves of the default's form and α⁰."""
    table = _table(results)
    grid, curves = [], []
    shown = [PLAIN, *({**settings["default"], "ties": ties} for ties in settings["ties"])]
    for schedule in settings["schedules"]:
        for how in (PLAIN, *configurations(settings)):
            where = _where(schedule, how)
            means = {key: table.mean(key, **where) for key in ("first", "first_ten", "to_50", "to_80", "final")}
            never = int(table.values("never_80", **where).sum())
            ratio = table.ratio("to_80", where, _where(schedule, PLAIN)).to_dict()
            numbers = {key: number.to_dict() for key, number in means.items()}
            grid.append({**where, **numbers, "never_80": never, "to_80_ratio": ratio})
        for how in shown:
            where = _where(schedule, how)
            about = {"curve_of": {key: how[key] for key in KEYS}, "schedule": schedule}
            curves.append(about | table.curve("curve", parts=BAND, **where))
    grid += _crossed_rows(settings, results)
    return [*grid, {"curve_edges": block_edges(settings["episodes"]).tolist()}, *curves]


def _crossed_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The choices of learning, a row for each."""
    table, found = _crossed_table(results, settings["crossed_runs"]), []
    for choice in crossed_choices(settings):
        numbers = {key: table.mean(key, **choice).to_dict() for key in ("first", "to_80", "final")}
        ratio = table.ratio("to_80", choice, without_ties(choice)).to_dict()
        found.append({**choice, **numbers, "to_80_ratio": ratio})
    return found
