"""Measures and rows of claim C4.8."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter4.c4_08_library_size.run import AGAINST
from lifelore.experiments.chapter4.surveillance_runs import EXACT, LEARNT
from lifelore.experiments.engine.estimates import share_of


def table(settings: Mapping, results: Sequence[Mapping], rule: str, model: str, against: str) -> np.ndarray:
    """Mean regret of every trial, (n_shares, n_episodes, n_trials)."""
    of = {r["share"]: np.array(r[against], float).T for r in results if (r["rule"], r["model"]) == (rule, model)}
    return np.stack([of[share] for share in settings["shares"]])


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """What size and episodes save, corner against corner, and in how many single steps the mean falls."""
    measured: dict[str, Estimate] = {}
    first, last = settings["episodes"][0], settings["episodes"][-1]
    for rule in settings["rules"]:
        for model in (LEARNT, EXACT):
            for against in AGAINST:
                found = table(settings, results, rule, model, against)
                name = f"{rule.replace(', ', '_')}_{model}" + ("" if against == "all" else "_library_regret")
                measured[f"saved_by_size_early_{name}"] = _saved(found[0, 0], found[-1, 0])
                measured[f"saved_by_size_late_{name}"] = _saved(found[0, -1], found[-1, -1])
                measured[f"saved_by_episodes_small_{name}"] = _saved(found[0, 0], found[0, -1])
                measured[f"saved_by_episodes_whole_{name}"] = _saved(found[-1, 0], found[-1, -1])
                mean = found.mean(axis=2)
                measured[f"steps_of_size_{name}"] = share_of((np.diff(mean, axis=0) < 0).ravel())
                measured[f"steps_of_episodes_{name}"] = share_of((np.diff(mean, axis=1) < 0).ravel())
                measured[f"least_step_of_size_late_{name}"] = _least(found[:, -1])
                measured[f"regret_whole_{last}_{name}"] = mean_estimate(found[-1, -1])
                measured[f"regret_whole_{first}_{name}"] = mean_estimate(found[-1, 0])
    return measured


def _saved(before: np.ndarray, after: np.ndarray) -> Estimate:
    """How much less `after` is, trial by trial."""
    return mean_estimate(before - after)


def _least(found: np.ndarray) -> Estimate:
    """The smallest of what one step in size saves, (n_shares, n_trials)."""
    steps = [_saved(small, large) for small, large in pairwise(found)]
    return min(steps, key=lambda step: step.value)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a cell: mean regret up to each number of episodes, its standard error, and tasks met in training."""
    kept = []
    for result in results:
        row = {key: result[key] for key in ("rule", "model", "share")}
        for against in AGAINST:
            values = np.array(result[against], float)
            row[against] = values.mean(axis=0).round(3).tolist()
            row[f"{against}_error"] = (values.std(axis=0, ddof=1) / len(values) ** 0.5).round(3).tolist()
        row["share_met"] = round(float(np.mean(result["met"])), 4)
        kept.append(row)
    return kept
