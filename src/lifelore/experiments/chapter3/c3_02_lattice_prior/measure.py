"""Measures and rows of claim C3.2."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter3.c3_02_lattice_prior.run import PLAIN, configurations
from lifelore.experiments.engine.curve_blocks import block_edges


def _methods(results: Sequence[Mapping], schedule, how: Mapping) -> list[Mapping]:
    """One configuration under one schedule, run by run."""
    keys = ("ties", "alpha0", "form")
    return [
        method
        for result in results
        if result["kind"] == "grid" and result["schedule"] == schedule
        for method in result["methods"]
        if all(method[key] == how[key] for key in keys)
    ]


def _column(methods: Sequence[Mapping], key: str) -> np.ndarray:
    return np.array([method[key] for method in methods], float)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The headline at the default, the shares of the grid, and the online series."""
    return {
        **_headline(settings, results),
        **_grid_shares(settings, results),
        **_online_measures(settings, [r for r in results if r["kind"] == "online"]),
    }


def _headline(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    default = settings["default"]
    found = {}
    methods = {
        "q_learning": _methods(results, default["schedule"], PLAIN),
        "eps_qsap": _methods(results, default["schedule"], default),
    }
    for name, of_runs in methods.items():
        for key in ("first", "first_ten", "to_50", "to_80", "never_80", "final"):
            found[f"{key}_{name}"] = mean_estimate(_column(of_runs, key))
    for key in ("to_50", "to_80"):
        both = [_column(methods[name], key) for name in ("eps_qsap", "q_learning")]
        found[f"{key}_ratio"] = ratio_estimate(*both)
    optimal = [r["optimal"] for r in results if r["kind"] == "grid" and r["schedule"] == default["schedule"]]
    found["optimal_return"] = mean_estimate(optimal)
    return found


def _grid_shares(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of the grid's cells in which the two halves of the claim hold, each by its interval."""
    grid = [row for row in _grid_rows(settings, results) if row["form"]]
    positive = np.array([_beyond(row["first"], above=0.0) for row in grid])
    faster = np.array([_beyond(row["to_80_ratio"], below=1.0) for row in grid])
    shares = {"positive_at_once": positive, "faster_to_80": faster, "both": positive & faster}
    return {
        f"grid_{name}": Estimate(float(share.mean()), float(np.median(share)), None, len(share))
        for name, share in shares.items()
    }


def _beyond(number: Mapping, above: float | None = None, below: float | None = None) -> bool:
    if number["ci95"] is None:
        return False
    low, high = number["ci95"]
    return low > above if above is not None else high < below


def _online_measures(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    plain = np.array([r["plain"] for r in results])
    optimal = np.array([r["optimal"] for r in results])
    gain = {
        (source, n): np.array([r["first_ten"][f"{source}_{n}"] for r in results]) - plain
        for source in ("learnt", "exact")
        for n in settings["online_tasks"]
    }
    found = {f"online_gain_after_{n}_{source}": mean_estimate(g) for (source, n), g in gain.items()}
    all_of_it = settings["training_tasks"]
    lost = (gain["learnt", all_of_it] - gain["exact", all_of_it]) / optimal
    found["online_minus_exact_of_optimal"] = mean_estimate(lost)
    found["q_learning_is_uniform_prior"] = mean_estimate([float(r["same"]) for r in results])
    return found


def _grid_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    found = []
    for schedule in settings["schedules"]:
        plain = _methods(results, schedule, PLAIN)
        for how in (PLAIN, *configurations(settings)):
            methods = _methods(results, schedule, how)
            row = {"schedule": schedule, **how}
            for key in ("first", "first_ten", "to_50", "to_80", "final"):
                row[key] = mean_estimate(_column(methods, key)).to_dict()
            row["never_80"] = int(_column(methods, "never_80").sum())
            ratio = ratio_estimate(_column(methods, "to_80"), _column(plain, "to_80"))
            row["to_80_ratio"] = ratio.to_dict()
            found.append(row)
    return found


def _curve_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean curves with 95 % intervals (t, over runs) in blocks of episodes."""
    from scipy.stats import t

    edges = block_edges(settings["episodes"])
    found = [{"curve_edges": edges.tolist()}]
    hows = [PLAIN, *({**settings["default"], "ties": ties} for ties in settings["ties"])]
    for schedule in settings["schedules"]:
        for how in hows:
            curves = np.array([m["curve"] for m in _methods(results, schedule, how)])
            mean, n = curves.mean(axis=0), len(curves)
            half = t.ppf(0.975, n - 1) * curves.std(axis=0, ddof=1) / np.sqrt(n) if n > 1 else 0 * mean
            name = {key: how[key] for key in ("ties", "alpha0", "form")}
            curve = {"mean": mean.tolist(), "low": (mean - half).tolist(), "high": (mean + half).tolist()}
            found.append({"curve_of": name, "schedule": schedule, **curve})
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The whole grid, a row for each cell, then the curves of the default's form and α⁰."""
    return _grid_rows(settings, results) + _curve_rows(settings, results)
