"""C3.3: in noise mazes, Q-learning with a prior on percepts against a prior on the lattice's places and none.

What was known to each beforehand: Q-learning nothing; ε-QPAP the optimal policies of 10 tasks, each in another
noise maze; ε-QSAP those of 10 tasks on the lattice, as the thesis's text has it. Each prior is also measured as
trained like the other. What the thesis leaves open is crossed in a grid, one stated default its headline.
Thesis: §3.4.1, Figure 3.5.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.action.priors.action_prior import FORMS
from lifelore.core.errors import InputError
from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.grids.lattice import lattice
from lifelore.experiments.chapter3.c3_03_noise_maze_prior.noise_learning import (
    COMPARED,
    KEYS,
    METHODS,
    PLAIN,
    cells,
    hows,
    run_cell,
)
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.curve_blocks import block_edges
from lifelore.experiments.engine.estimates import is_above, is_below, share_of
from lifelore.experiments.engine.learning_settings import (
    check_among,
    check_counts,
    check_default,
    check_learning,
    check_windows,
)
from lifelore.experiments.engine.open_choices import default_of, how_key, plain_how, runs_by_cell
from lifelore.experiments.engine.predicate import Predicate

FULL = {
    "size": 23,
    "density": [0.5, 0.8],
    "discount": 0.95,
    "runs": 30,
    "training_tasks": [10, 35],
    "test_tasks": 10,
    "episodes": 1000,
    "max_steps": [200, 1000],
    "learning_rate": 0.5,
    "window": 10,
    "last": 100,
    "ties": ["uniform", "prior"],
    "schedules": [[0.1, 1.0, 0.1], [1.0, 0.98, 0.01], [1.0, 0.995, 0.01]],
    "alpha0": [0.1, 1.0],
    "forms": ["proportion", "dirichlet", "support"],
    "default": {
        "ties": "uniform",
        "schedule": [1.0, 0.98, 0.01],
        "alpha0": 0.1,
        "form": "proportion",
        "max_steps": 1000,
        "training_tasks": 10,
    },
}
QUICK = {
    **FULL,
    "size": 11,
    "runs": 3,
    "training_tasks": [3, 5],
    "test_tasks": 2,
    "episodes": 120,
    "max_steps": [100, 200],
    "last": 20,
    "default": {**FULL["default"], "max_steps": 200, "training_tasks": 5},
}
PAIRS = (("qpap", PLAIN), ("qpap", "qsap"), ("qsap", PLAIN))
"""Which methods are compared, the first with the second."""
Found = dict[tuple, list[Mapping]]


def _check(settings: Mapping) -> None:
    check_counts(settings, ("runs", "training_tasks", "test_tasks", "episodes", "max_steps", "window", "last"))
    check_windows(settings, ("window", "last"))
    check_learning(settings)
    check_among(settings, "forms", FORMS)
    among = {"ties": "ties", "schedule": "schedules", "alpha0": "alpha0", "form": "forms"}
    check_default(settings, {**among, "max_steps": "max_steps", "training_tasks": "training_tasks"})
    n_states = lattice(settings["size"], settings["discount"]).n_states
    if max(settings["training_tasks"]) > n_states:
        raise InputError(f"training_tasks must be at most the lattice's {n_states} cells that can be goals")
    density = settings["density"]
    if np.shape(density) != (2,) or not 0 <= density[0] <= density[1] < 1:
        raise InputError(f"density must be two shares of obstacles, rising, in [0, 1), got {density}")


def _by_method(results: Sequence[Mapping]) -> Found:
    """(method, cell of the grid) to its numbers, run by run."""
    return runs_by_cell(results, ("method",), KEYS)


def _of(found: Found, method: str, how: Mapping, key: str) -> np.ndarray:
    how = plain_how(how, KEYS) if method == PLAIN else how
    return np.array([numbers[key] for numbers in found[method, how_key(how, KEYS)]], float)


def _compare(found: Found, how: Mapping) -> dict[str, Estimate]:
    """First returns as differences and episodes to 80 % as ratios, paired by run, of one cell of the grid."""
    compared = {}
    for one, other in PAIRS:
        first, other_first = (_of(found, method, how, "first") for method in (one, other))
        compared[f"first_{one}_minus_{other}"] = jumpstart(first, other_first)
        to_80 = [_of(found, method, how, "to_80") for method in (one, other)]
        compared[f"to_80_ratio_{one}_to_{other}"] = ratio_estimate(*to_80)
    return compared


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The headline at the default, each prior trained like the other, and shares of the grid."""
    found, default = _by_method(results), default_of(settings, KEYS)
    measured = {}
    for method in (PLAIN, *METHODS):
        for key in ("first", "first_ten", "to_50", "to_80", "never_80", "final"):
            measured[f"{key}_{method}"] = mean_estimate(_of(found, method, default, key))
    measured |= _compare(found, default)
    measured["optimal_return"] = mean_estimate([result["optimal"] for result in results])
    return measured | _grid_shares(settings, found)


def _grid_shares(settings: Mapping, found: Found) -> dict[str, Estimate]:
    """Shares of the grid's cells in which each part of the claim holds, by its interval."""
    compared = [_compare(found, how) for how in hows(settings)]
    higher = {p: [is_above(c[f"first_{p[0]}_minus_{p[1]}"], 0.0) for c in compared] for p in PAIRS}
    faster = {p: [is_below(c[f"to_80_ratio_{p[0]}_to_{p[1]}"], 1.0) for c in compared] for p in PAIRS}
    worse = np.array([is_below(c[f"first_qsap_minus_{PLAIN}"], 0.0) for c in compared])
    slower = np.array([is_above(c[f"to_80_ratio_qsap_to_{PLAIN}"], 1.0) for c in compared])
    than_plain, than_state = PAIRS[:2]
    better_at_first = np.logical_and(higher[than_plain], higher[than_state])
    sooner = np.logical_and(faster[than_plain], faster[than_state])
    return {
        "grid_qpap_better_at_first": share_of(better_at_first),
        "grid_qpap_faster": share_of(sooner),
        "grid_qpap_beats_both": share_of(better_at_first & sooner),
        "grid_qsap_worse_at_first": share_of(worse),
        "grid_qsap_slower": share_of(slower),
        "grid_qsap_worse": share_of(worse & slower),
    }


def _grid_rows(settings: Mapping, found: Found) -> list[dict]:
    grid = []
    for how in hows(settings):
        row = {key: how[key] for key in KEYS}
        row |= {name: number.to_dict() for name, number in _compare(found, how).items()}
        for method in (PLAIN, *COMPARED):
            row[f"to_80_{method}"] = mean_estimate(_of(found, method, how, "to_80")).to_dict()
            row[f"never_80_{method}"] = int(_of(found, method, how, "never_80").sum())
            row[f"first_{method}"] = float(_of(found, method, how, "first").mean())
        grid.append(row)
    return grid


def _curve_rows(settings: Mapping, found: Found) -> list[dict]:
    """Mean curves with 95 % intervals (t, over runs) in blocks of episodes, the default under each schedule."""
    from scipy.stats import t

    found_rows: list[dict] = [{"curve_edges": block_edges(settings["episodes"]).tolist()}]
    for schedule in settings["schedules"]:
        how = {**default_of(settings, KEYS), "schedule": schedule}
        for method in (PLAIN, *METHODS):
            key = how_key(plain_how(how, KEYS) if method == PLAIN else how, KEYS)
            curves = np.array([numbers["curve"] for numbers in found[method, key]])
            mean, n = curves.mean(axis=0), len(curves)
            half = t.ppf(0.975, n - 1) * curves.std(axis=0, ddof=1) / np.sqrt(n) if n > 1 else 0 * mean
            to_80 = mean_estimate(_of(found, method, how, "to_80")).to_dict()
            curve = {"mean": mean.tolist(), "low": (mean - half).tolist(), "high": (mean + half).tolist()}
            found_rows.append({"curve_of": method, "schedule": schedule, "to_80": to_80, **curve})
    return found_rows


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The whole grid, a row for each cell, then the curves of the default."""
    found = _by_method(results)
    return _grid_rows(settings, found) + _curve_rows(settings, found)


def _draw(result: Mapping):
    from lifelore.experiments.chapter3.c3_03_noise_maze_prior.figure_noise_grid import draw_noise_grid

    return draw_noise_grid(result)


CLAIM = Claim(
    id="C3.3",
    title="Q-learning with a prior on percepts in noise mazes (Figure 3.5)",
    thesis="In 23×23 mazes of 50 to 80 % noise, ε-QPAP outperforms ε-QSAP with its lattice-trained state prior "
    "and Q-learning in initial performance and in time to convergence, over 10 test tasks; uniform priors "
    "outperform the lattice-trained state priors.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C3.3"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    check=_check,
)
