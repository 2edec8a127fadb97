"""Measures and rows of claim C3.7."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.factory.contexts import PHI
from lifelore.experiments.chapter3.feature_priors import KEYS, METHODS, PLAIN, STATE, hows, method_how
from lifelore.experiments.engine.estimates import share_of
from lifelore.experiments.engine.open_choices import default_of, how_key, runs_by_cell

NUMBERS = ("first", "early", "all", "late")
Found = dict[tuple, list[Mapping]]


def _by_method(results: Sequence[Mapping]) -> Found:
    """(method, cell of the grid as it meets it) to its numbers, run by run."""
    return runs_by_cell(results, ("method",), KEYS)


def _numbers_of(found: Found, method: str, how: Mapping) -> list[Mapping]:
    return found[method, how_key(method_how(method, how), KEYS)]


def _of(found: Found, method: str, how: Mapping, key: str = "all") -> np.ndarray:
    return np.array([numbers[key] for numbers in _numbers_of(found, method, how)], float)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Every method at the default, what the claim compares there, and shares of the grid."""
    found, default = _by_method(results), default_of(settings, KEYS)
    optimal = np.array([result["optimal"] for result in results])
    measured = {"optimal_reward": mean_estimate(optimal)}
    for method in METHODS:
        for key in NUMBERS:
            measured[f"{key}_{method}"] = mean_estimate(_of(found, method, default, key))
    every = {method: _of(found, method, default) for method in METHODS}
    pairs = [("phi3", "phi1"), ("phi3", "phi2"), ("phi4", "phi3"), ("phi4", "phi2"), (STATE, PLAIN)]
    for ours, theirs in [*pairs, *((phi, STATE) for phi in PHI)]:
        measured[f"{ours}_minus_{theirs}"] = jumpstart(every[ours], every[theirs])
    distance = optimal - every[PLAIN]
    measured["phi2_minus_phi3_of_distance"] = ratio_estimate(every["phi2"] - every["phi3"], distance)
    for method in METHODS[1:]:
        measured[f"closed_{method}"] = ratio_estimate(every[method] - every[PLAIN], distance)
    return measured | _grid_shares(settings, found)


def _grid_shares(settings: Mapping, found: Found) -> dict[str, Estimate]:
    """Shares of the grid's cells in which the means stand in the order that the thesis reports."""
    above, best = [], []
    for how in hows(settings):
        mean = {method: float(_of(found, method, how).mean()) for method in METHODS}
        of_phi = {phi: mean[phi] for phi in PHI}
        above.append(min(of_phi.values()) > mean[STATE] > mean[PLAIN])
        best.append(max(of_phi.values()) == of_phi["phi3"])
    return {"grid_features_above_state_above_uniform": share_of(above), "grid_phi3_best": share_of(best)}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The whole grid, a row for each cell, then the curves of the default under every schedule."""
    found = _by_method(results)
    optimal = np.array([result["optimal"] for result in results])
    grid = []
    for how in hows(settings):
        row: dict = {key: how[key] for key in KEYS}
        every = {method: _of(found, method, how) for method in METHODS}
        row |= {f"all_{method}": float(values.mean()) for method, values in every.items()}
        for method in METHODS[1:]:
            closed = ratio_estimate(every[method] - every[PLAIN], optimal - every[PLAIN])
            row[f"closed_{method}"] = closed.to_dict()
        grid.append(row)
    return grid + [_curve_row(found, settings, s, m) for s in settings["schedules"] for m in METHODS]


def _curve_row(found: Found, settings: Mapping, schedule: Sequence[float], method: str) -> dict:
    """Mean over runs of each episode, and the standard deviation between runs."""
    how = {**default_of(settings, KEYS), "schedule": schedule}
    curves = np.array([numbers["mean"] for numbers in _numbers_of(found, method, how)])
    deviation = curves.std(axis=0, ddof=1) if len(curves) > 1 else np.zeros(curves.shape[1])
    return {
        "curve_of": method,
        "schedule": schedule,
        "mean": np.round(curves.mean(axis=0), 2).tolist(),
        "deviation": np.round(deviation, 2).tolist(),
    }
