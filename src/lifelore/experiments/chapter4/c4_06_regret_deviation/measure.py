"""Measures and rows of claim C4.6."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter4.c4_06_regret_deviation.run import AFTER, METHODS
from lifelore.experiments.chapter4.reuse_rules import OF_THESIS
from lifelore.experiments.chapter4.reuse_runs import grouped_deviation
from lifelore.experiments.chapter4.surveillance_runs import DEFAULT_WORLD, NOISES, by_group, find, name_of
from lifelore.experiments.engine.estimates import share_of

PRINTED = {
    "eps-greedy": (72.193, 97.999, 83.21, 86.172),
    "sampling": (103.07, 86.469, 18.834, 10.897),
    "KG": (76.577, 75.268, 7.1152, 18.489),
    "BE": (96.529, 91.288, 17.74, 13.813),
    "PI": (15.695, 62.4, 72.173, 101.69),
    "EI": (27.801, 33.112, 16.011, 11.142),
}
"""After the episodes of `AFTER`."""
READINGS = {
    "size of the difference of two pays": ("realised", True),
    "difference of two pays": ("realised", False),
    "paid less than the best mean": ("against_mean", False),
    "expected": ("at", False),
}
"""Which regret of `surveillance_runs`, and whether its sign is dropped."""
DEFAULT_READING = "size of the difference of two pays"
CASES_SHOWN = ("exact", "headline")


def deviations(result: Mapping, reading: str, episode: int) -> np.ndarray:
    """Standard deviation over the tasks of each group, (n_groups,); with n − 1, as of a sample."""
    key, size = READINGS[reading]
    values = by_group({"groups": result["groups"], key: result[key][str(episode)]}, key)
    return (np.abs(values) if size else values).std(axis=1, ddof=1)


def agreement(result: Mapping, printed: Sequence[float], reading: str) -> list[bool]:
    """Whether each printed number lies within the middle 95 % of the groups' deviations."""
    inside = []
    for episode, number in zip(AFTER, printed, strict=True):
        low, high = np.quantile(deviations(result, reading, episode), [0.025, 0.975])
        inside.append(bool(low <= number <= high))
    return inside


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """How many printed numbers agree, by rule and form; deviations over all tasks after 20 and 50 episodes."""
    measured: dict[str, Estimate] = {}
    for case in CASES_SHOWN:
        for form in ("", ", printed"):
            every = []
            for name in OF_THESIS:
                method = name + form if name + form in METHODS else name
                inside = agreement(find(results, method, case), PRINTED[name], DEFAULT_READING)
                every += inside
                measured[f"agree_{name_of(method, case)}"] = share_of(inside)
            measured[f"agree_all{form.replace(', ', '_')}_{case}"] = share_of(every)
        for name in METHODS:
            for episode in AFTER:
                result = find(results, name, case)
                key, _ = READINGS[DEFAULT_READING]
                values = np.abs(by_group({"groups": result["groups"], key: result[key][str(episode)]}, key))
                measured[f"deviation_{episode}_{name_of(name, case)}"] = grouped_deviation(values)
    near = agreement(find(results, "BE, κ 30", "exact"), PRINTED["BE"], DEFAULT_READING)
    measured["agree_BE_near_greedy_exact"] = share_of(near)
    for reading in READINGS:
        inside = [agreement(find(results, name, "exact"), PRINTED[name], reading) for name in OF_THESIS]
        measured[f"agree_all_{reading.replace(' ', '_')}"] = share_of(np.ravel(inside))
    other = next(noise for noise in NOISES if noise != DEFAULT_WORLD["noise"])
    inside = [
        agreement(find(results, name, "exact", noise=other), PRINTED[name], DEFAULT_READING) for name in OF_THESIS
    ]
    measured["agree_all_other_noise"] = share_of(np.ravel(inside))
    return measured


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a cell and reading: quantiles of the groups' deviations after each printed episode."""
    kept = []
    for result in results:
        for reading in READINGS:
            row = {key: result[key] for key in ("method", "case", "noise")}
            found = [np.quantile(deviations(result, reading, k), [0.025, 0.5, 0.975]) for k in AFTER]
            kept.append({**row, "reading": reading, "quantiles": np.round(found, 2).tolist()})
    return kept
