"""Measures and rows of claim C3.3."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter3.c3_03_noise_maze_prior.run import COMPARED, KEYS, METHODS, PLAIN, hows
from lifelore.experiments.engine.curve_blocks import block_edges
from lifelore.experiments.engine.estimates import is_above, is_below, share_of
from lifelore.experiments.engine.open_choices import default_of, how_key, plain_how, runs_by_cell

PAIRS = (("qpap", PLAIN), ("qpap", "qsap"), ("qsap", PLAIN))
"""Which methods are compared, the first with the second."""
Found = dict[tuple, list[Mapping]]


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
