"""C3.7: in factories that change with each task, priors over features beside a prior over states and none.

Every prior knows the optimal policies of the same 80 other factories and lists; learners without one know nothing.
The thesis does not say how ε falls, how ties are broken, what α⁰ is, when an episode is broken off, or how a
configuration is coded in the prior over states: all are varied. As in C3.11 an optimal episode's moves cost about
what its task pays, so *nearly as good* is asked of the distance from learning without a prior to the optimum.
Thesis: §3.4.4, §3.4.5, Figure 3.11.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.action.priors.exploration import TIES
from lifelore.core.errors import InputError
from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.factory.contexts import ENCODINGS, PHI
from lifelore.domains.factory.factory import N_COMPONENTS
from lifelore.experiments.chapter3.feature_priors import (
    KEYS,
    METHODS,
    PLAIN,
    STATE,
    cells,
    hows,
    method_how,
    run_cell,
)
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import share_of
from lifelore.experiments.engine.learning_settings import (
    check_among,
    check_counts,
    check_default,
    check_learning,
    check_windows,
)
from lifelore.experiments.engine.open_choices import default_of, how_key, runs_by_cell
from lifelore.experiments.engine.predicate import Predicate

FULL = {
    "discount": 0.99,
    "components": 4,
    "runs": 20,
    "policies": [10, 80],
    "test_tasks": 5,
    "episodes": 100,
    "early": 10,
    "learning_rate": 0.5,
    "max_steps": [2000, 20000],
    "encodings": list(ENCODINGS),
    "ties": ["uniform", "prior"],
    "schedules": [[0.1, 1.0, 0.1], [1.0, 0.95, 0.01]],
    "alpha0": [0.1, 1.0],
    "default": {
        "encoding": "global",
        "schedule": [1.0, 0.95, 0.01],
        "ties": "uniform",
        "alpha0": 0.1,
        "max_steps": 2000,
        "policies": 80,
    },
}
QUICK = {
    **FULL,
    "components": 1,
    "runs": 3,
    "policies": [1, 3],
    "test_tasks": 2,
    "episodes": 20,
    "early": 5,
    "max_steps": [100, 200],
    "default": {**FULL["default"], "max_steps": 200, "policies": 3},
}
NUMBERS = ("first", "early", "all", "late")

Found = dict[tuple, list[Mapping]]


def _check(settings: Mapping) -> None:
    counts = ("runs", "policies", "test_tasks", "episodes", "early", "max_steps", "components")
    check_counts(settings, counts)
    check_windows(settings, ("early",))
    check_learning(settings)
    check_among(settings, "encodings", ENCODINGS)
    check_among(settings, "ties", TIES)
    among = {"encoding": "encodings", "schedule": "schedules", **{k: k for k in KEYS[2:]}}
    check_default(settings, among)
    check_components(settings)
    if min(settings["alpha0"]) <= 0:
        raise InputError(f"alpha0 must be positive, got {settings['alpha0']}")


def check_components(settings: Mapping) -> None:
    """Raise `InputError` for more components than a factory has points for."""
    if settings["components"] > N_COMPONENTS:
        raise InputError(f"components must be at most {N_COMPONENTS}, got {settings['components']}")


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


def _draw(result: Mapping):
    from lifelore.experiments.chapter3.feature_curves import draw_feature_curves

    return draw_feature_curves(result)


CAUSES = {
    "φ1 above states": "what the own cell is and what is left to do tell nothing of the walls around, so that "
    "moves are drawn by how often each was best anywhere",
    "features above states in most of the grid": "φ1 lies below the prior over states in every cell",
}

CLAIM = Claim(
    id="C3.7",
    title="Priors over four sets of features in factories that change (Figure 3.11)",
    thesis="In the modified factory, 4 random components, priors from 80 training policies, 10 runs: φ3 is the "
    "most beneficial set, φ2 performs almost as well and the richest, φ4, not better; all four improve on the "
    "prior over states, which improves on none.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C3.7"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=_check,
)
