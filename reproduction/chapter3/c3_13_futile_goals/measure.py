"""Measures and rows of claim C3.13."""

from collections.abc import Callable, Mapping, Sequence
from itertools import product

import numpy as np
from scipy.stats import binomtest

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from reproduction.engine.estimates import UNMEASURED, mean_or_unmeasured
from reproduction.engine.results_table import ResultsTable

KEYS = ("actions", "alike", "alpha0", "tasks")


def _ratios(results: Sequence[Mapping], draws: int, wanted: Callable[[Mapping], bool]) -> list[float]:
    """For each run, the measured frequency over that of the formula, a mean over the `wanted` cases."""
    return [
        float(np.mean([c["taken"] / (draws * c["formula"]) for c in result["constructed"] if wanted(c)]))
        for result in results
    ]


def slope(tasks: Sequence[int], probs: Sequence[float]) -> float:
    """Least-squares slope of the logarithm of `probs` over that of `tasks`."""
    return float(np.polyfit(np.log(tasks), np.log(probs), 1)[0])


def _slopes(settings: Mapping, results: Sequence[Mapping]) -> list[float]:
    """The measured slope at the default, run by run; without runs that had no hit at some number of tasks."""
    default, slopes = {**settings["default"], "alike": 1}, []
    for result in results:
        cases = ResultsTable(result["constructed"], KEYS).select(**default).records
        cases = [case for case in cases if case["tasks"]]
        if all(case["taken"] for case in cases):
            slopes.append(slope([c["tasks"] for c in cases], [c["taken"] / settings["draws"] for c in cases]))
    return slopes


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The prior's probability, the measured frequency and its decay, and random worlds."""
    table, draws, measured = ResultsTable.nested(results, "constructed", KEYS), settings["draws"], {}
    for name, by_state in (("states", True), ("percepts", False)):
        cases = [case for case in table.records if (case["alike"] == 1) is by_state]
        errors = [abs(case["prior"] / case["formula"] - 1) for case in cases]
        measured[f"prior_error_{name}"] = Estimate(max(errors), float(np.median(errors)), None, len(errors))
        ratios = _ratios(results, draws, lambda c, b=by_state: (c["alike"] == 1) is b and c["tasks"])
        measured[f"frequency_ratio_{name}"] = mean_estimate(ratios)
    measured["frequency_ratio_no_task"] = mean_estimate(_ratios(results, draws, lambda c: not c["tasks"]))
    measured["slope_default"] = mean_or_unmeasured(_slopes(settings, results))
    unlearnt = [c for c in table.select(tasks=max(settings["tasks"])).records if "taken_uniform_ties" in c]
    for ties in ("uniform", "prior"):
        ratios = [case[f"taken_{ties}_ties"] / (draws * case["formula"]) for case in unlearnt]
        measured[f"unlearnt_ratio_{ties}_ties"] = mean_estimate(ratios)
    worlds = [case for result in results for case in result["found"]]
    for name in ("states", "percepts"):
        shares = [case[f"below_{name}"] / case["entering"] for case in worlds]
        measured[f"share_below_{name}"] = mean_or_unmeasured(shares)
    taken, expected = (np.array([case[key] for case in worlds]) for key in ("taken", "expected"))
    ratio = ratio_estimate(taken / draws, expected) if worlds else UNMEASURED
    return measured | {"frequency_ratio_random": ratio}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Constructed cases pooled over runs with exact intervals; then worlds as found, by kind and tasks."""
    table, draws, found = ResultsTable.nested(results, "constructed", KEYS), settings["draws"] * len(results), []
    for case in results[0]["constructed"]:
        cell = {key: case[key] for key in KEYS}
        taken = int(table.values("taken", **cell).sum())
        low, high = binomtest(taken, draws).proportion_ci()
        numbers = {"measured": taken / draws, "low": float(low), "high": float(high)}
        found.append({**cell, "formula": case["formula"], **numbers})
    worlds = ResultsTable.nested(results, "found", ("kind", "tasks"))
    for kind, n_tasks in product(settings["kinds"], settings["found_tasks"]):
        cases = worlds.select(kind=kind, tasks=n_tasks).records
        row = {"kind": kind, "tasks": n_tasks, "worlds": len(cases)}
        for name in ("entering", "below_states", "below_percepts", "below_percepts_pooled"):
            row[name] = sum(case[name] for case in cases)
        for name in ("least", "least_percepts"):
            row[name] = [round(case[name] / case["bound"], 5) for case in cases]
        found.append(row)
    return found
