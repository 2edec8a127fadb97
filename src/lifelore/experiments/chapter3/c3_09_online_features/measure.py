"""Measures and rows of claim C3.9."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.learning.learning_metrics import jumpstart
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter3.c3_09_online_features.run import ASKED, KEYS, METHODS, hows, method_how
from lifelore.experiments.chapter3.online_selection import FULL as ALL_TEN
from lifelore.experiments.chapter3.online_selection import SELECTED, UNIFORM
from lifelore.experiments.engine.estimates import share_of
from lifelore.experiments.engine.open_choices import default_of, how_key, runs_by_cell

PARTS = ("first", "last")
Found = dict[tuple, list[Mapping]]


def _by_method(results: Sequence[Mapping]) -> Found:
    """(method, cell of the grid as it meets it) to its numbers, run by run."""
    return runs_by_cell(results, ("method",), KEYS)


def _tasks_of(found: Found, method: str, how: Mapping, part: str) -> np.ndarray:
    """(n_runs, n_tasks) numbers of each task."""
    return np.array([numbers[part] for numbers in found[method, how_key(method_how(method, how), KEYS)]], float)


def _of(found: Found, method: str, how: Mapping, part: str) -> np.ndarray:
    """Each run's mean over the tasks after the first, (n_runs,)."""
    return _tasks_of(found, method, how, part)[:, 1:].mean(axis=1)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Every method by whose policies count, what the claim compares there, and shares of the grid."""
    found = _by_method(results)
    optimal = np.array([np.mean(result["optimal"][1:]) for result in results])
    measured = {"optimal_reward": mean_estimate(optimal)}
    for source in ASKED:
        how = {**default_of(settings, KEYS), "source": source}
        for name, number in _compared(found, how, optimal).items():
            measured[f"{source}_{name}"] = number
    return measured | {"grid_order_at_first": share_of([_is_ordered(found, how) for how in hows(settings)])}


def _compared(found: Found, how: Mapping, optimal: np.ndarray) -> dict[str, Estimate]:
    """The three methods in a cell of the grid, and their paired differences."""
    distance = optimal - _of(found, UNIFORM, how, "first")
    measured = {}
    for part in PARTS:
        every = {method: _of(found, method, how, part) for method in METHODS}
        for method, values in every.items():
            measured[f"{part}_{method}"] = mean_estimate(values)
        for ours, theirs in ((SELECTED, ALL_TEN), (ALL_TEN, UNIFORM), (SELECTED, UNIFORM)):
            name = f"{part}_{ours}_minus_{theirs}"
            measured[name] = jumpstart(every[ours], every[theirs])
            measured[f"{name}_of_distance"] = ratio_estimate(every[ours] - every[theirs], distance)
    features = _tasks_of(found, SELECTED, how, "n_features")[:, -1]
    return measured | {"features_after_last_task": mean_estimate(features)}


def _is_ordered(found: Found, how: Mapping) -> bool:
    """Selected ≥ all ten > uniform in the first episode, by means."""
    uniform, ten, selected = (float(_of(found, method, how, "first").mean()) for method in METHODS)
    return selected >= ten > uniform


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The grid, a row for each cell, then the default's curves over tasks by source."""
    found = _by_method(results)
    grid = []
    for how in hows(settings):
        row: dict = {key: how[key] for key in KEYS}
        for part in PARTS:
            row |= {f"{part}_{method}": float(_of(found, method, how, part).mean()) for method in METHODS}
            pair = [_of(found, method, how, part) for method in (SELECTED, ALL_TEN)]
            row[f"{part}_selected_minus_full"] = jumpstart(*pair).to_dict()
        grid.append(row)
    lines = [(source, method, part) for source in settings["sources"] for method in METHODS for part in PARTS]
    return grid + [_curve_row(found, settings, *line) for line in lines]


def _curve_row(found: Found, settings: Mapping, source: str, method: str, part: str) -> dict:
    """Mean over runs of each task's first or last episode, and the standard deviation between runs."""
    values = _tasks_of(found, method, {**default_of(settings, KEYS), "source": source}, part)
    deviation = values.std(axis=0, ddof=1) if len(values) > 1 else np.zeros(values.shape[1])
    curve = {"mean": np.round(values.mean(axis=0), 2).tolist(), "deviation": np.round(deviation, 2).tolist()}
    return {"curve_of": method, "of_source": source, "part": part, **curve}
