"""Measures and rows of claim C3.13."""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.stats import binomtest

from lifelore.action.search.domain_reduction import futile_goal_probability
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.engine.estimates import UNMEASURED, mean_or_unmeasured, share_of

Case = Mapping


def _pooled(results: Sequence[Mapping]) -> list[dict]:
    """Constructed cases with what was taken over all runs; their worlds differ in the action's place alone."""
    found: dict[tuple, dict] = {}
    for result in results:
        for case in result["constructed"]:
            key = tuple(case[name] for name in ("actions", "alike", "alpha0", "tasks"))
            pool = found.setdefault(key, {**case, "taken": 0, "priors": []})
            pool["taken"] += case["taken"]
            pool["priors"].append(case["prior"])
    return list(found.values())


def _ratios(results: Sequence[Mapping], draws: int, wanted) -> list[float]:
    """For each run, what was taken over what the formula expects, a mean over its cases that are `wanted`."""
    return [
        float(np.mean([c["taken"] / (draws * c["formula"]) for c in result["constructed"] if wanted(c)]))
        for result in results
    ]


def _is_default(case: Case, settings: Mapping) -> bool:
    default = settings["default"]
    return case["alike"] == 1 and all(case[key] == default[key] for key in ("actions", "alpha0"))


def slope(tasks: Sequence[int], probs: Sequence[float]) -> float:
    """Least-squares slope of the logarithm of `probs` over that of `tasks`."""
    return float(np.polyfit(np.log(tasks), np.log(probs), 1)[0])


def _slopes(settings: Mapping, results: Sequence[Mapping]) -> list[float]:
    """The measured slope at the default, run by run; without runs that had no hit at some number of tasks."""
    slopes = []
    for result in results:
        cases = [c for c in result["constructed"] if _is_default(c, settings) and c["tasks"]]
        if all(case["taken"] for case in cases):
            slopes.append(slope([c["tasks"] for c in cases], [c["taken"] / settings["draws"] for c in cases]))
    return slopes


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """What the prior says, what is taken, how it falls with the number of tasks, and worlds as found."""
    pooled, draws = _pooled(results), settings["draws"]
    measured = {}
    for name, by_state in (("states", True), ("percepts", False)):
        cases = [c for c in pooled if (c["alike"] == 1) is by_state]
        errors = [abs(p / c["formula"] - 1) for c in cases for p in c["priors"]]
        measured[f"prior_error_{name}"] = Estimate(max(errors), float(np.median(errors)), None, len(errors))
        ratios = _ratios(results, draws, lambda c, b=by_state: (c["alike"] == 1) is b and c["tasks"])
        measured[f"frequency_ratio_{name}"] = mean_estimate(ratios)
    measured["frequency_ratio_no_task"] = mean_estimate(_ratios(results, draws, lambda c: not c["tasks"]))
    held = [_holds_formula(c, draws * len(results)) for c in pooled]
    measured["intervals_that_hold_formula"] = share_of(held)
    measured["slope_default"] = mean_or_unmeasured(_slopes(settings, results))
    tasks = [n for n in settings["tasks"] if n]
    for alpha0 in settings["alpha0"]:
        exact = slope(tasks, futile_goal_probability(settings["default"]["actions"], tasks, alpha0).tolist())
        measured[f"slope_of_formula_alpha0_{alpha0:g}"] = Estimate(exact, exact, None, len(tasks))
    measured |= _greedy(settings, results)
    return measured | _found(settings, results)


def _holds_formula(case: Case, draws: int) -> bool:
    """Whether the exact 95 % interval of the pooled frequency holds the formula's probability."""
    low, high = binomtest(case["taken"], draws, case["formula"]).proportion_ci()
    return bool(low <= case["formula"] <= high)


def _greedy(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """What is taken over the formula where ε is 0.1 and nothing is learnt yet, after the most tasks."""
    most, found = max(settings["tasks"]), {}
    for ties in ("uniform", "prior"):
        name = f"taken_{ties}_ties"
        cases = [c for r in results for c in r["constructed"] if name in c and c["tasks"] == most]
        values = [c[name] / (settings["draws"] * c["formula"]) for c in cases]
        found[f"unlearnt_ratio_{ties}_ties"] = mean_estimate(values)
    return found


def _found(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Worlds as found, each a number: shares of its actions below the bound, and its least probable action."""
    worlds = [case for result in results for case in result["found"]]
    measured = {}
    for name in ("states", "percepts", "percepts_pooled"):
        shares = [case[f"below_{name}"] / case["entering"] for case in worlds]
        measured[f"share_below_{name}"] = mean_or_unmeasured(shares)
    taken, expected = ([case[key] for case in worlds] for key in ("taken", "expected"))
    measured["frequency_ratio_random"] = (
        ratio_estimate(np.array(taken) / settings["draws"], expected) if worlds else UNMEASURED
    )
    measured["least_over_bound_states"] = mean_or_unmeasured([c["least"] / c["bound"] for c in worlds])
    at_bound = [c["least"] <= c["bound"] * (1 + 1e-9) for c in worlds]
    measured["worlds_at_the_bound"] = share_of(at_bound) if worlds else UNMEASURED
    measured["least_over_bound_percepts"] = mean_or_unmeasured([c["least_percepts"] / c["bound"] for c in worlds])
    return measured


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Constructed cases pooled over runs with exact intervals; then worlds as found, by kind and tasks."""
    draws = settings["draws"] * len(results)
    found = []
    for case in _pooled(results):
        low, high = binomtest(case["taken"], draws).proportion_ci()
        kept = {key: case[key] for key in ("actions", "alike", "alpha0", "tasks", "formula")}
        found.append({**kept, "measured": case["taken"] / draws, "low": float(low), "high": float(high)})
    worlds = [case for result in results for case in result["found"]]
    for kind in settings["kinds"]:
        for n_tasks in settings["found_tasks"]:
            of = [c for c in worlds if (c["kind"], c["tasks"]) == (kind, n_tasks)]
            row = {"kind": kind, "tasks": n_tasks, "worlds": len(of), "entering": sum(c["entering"] for c in of)}
            for name in ("states", "percepts", "percepts_pooled"):
                row[f"below_{name}"] = sum(c[f"below_{name}"] for c in of)
            row["least"] = [round(c["least"] / c["bound"], 5) for c in of]
            row["least_percepts"] = [round(c["least_percepts"] / c["bound"], 5) for c in of]
            found.append(row)
    return found
