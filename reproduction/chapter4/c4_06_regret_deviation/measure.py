"""C4.6: how many of the printed standard deviations agree with those of many groups of ten tasks."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.domains.surveillance.surveillance import NOISES
from reproduction.chapter4.c4_06_regret_deviation.run import AFTER, METHODS
from reproduction.chapter4.reuse.many_tasks import grouped_deviation
from reproduction.chapter4.reuse.rules import OF_THESIS
from reproduction.chapter4.surveillance.runs import DEFAULT_WORLD, find, name_of
from reproduction.engine.estimates import is_above, is_below, share_of

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
"""Regret of `surveillance.runs` by reading, and whether its sign is dropped."""
DEFAULT_READING = "size of the difference of two pays"
CASES_SHOWN = ("exact", "headline")
SMALL_LATE, LARGE_LATE = ("sampling", "KG", "BE", "EI"), ("eps-greedy", "PI")
"""Rules whose printed deviation after the last episode is below 20, and above 80."""
SMALL, LARGE = 25.0, 50.0
"""Bounds of deviations in the units of pay, whose noise has a deviation of 20."""


def regrets(result: Mapping, reading: str, episode: int) -> np.ndarray:
    """Regret of every task in one reading, (n_groups, n_tasks)."""
    key, size = READINGS[reading]
    values = np.reshape(result[key][str(episode)], (result["groups"], -1)).astype(float)
    return np.abs(values) if size else values


def deviations(result: Mapping, reading: str, episode: int) -> np.ndarray:
    """Standard deviation over the tasks of each group, (n_groups,); with n − 1, as of a sample."""
    return regrets(result, reading, episode).std(axis=1, ddof=1)


def agreement(result: Mapping, printed: Sequence[float], reading: str = DEFAULT_READING) -> list[bool]:
    """Whether each printed number lies within the middle 95 % of the groups' deviations."""
    inside = []
    for episode, number in zip(AFTER, printed, strict=True):
        low, high = np.quantile(deviations(result, reading, episode), [0.025, 0.975])
        inside.append(bool(low <= number <= high))
    return inside


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:

    def whole_table(
        case: str, form: str = "", reading: str = DEFAULT_READING, **world: str
    ) -> dict[str, list[bool]]:
        """By method the four answers; rules without a printed form count in their standard form."""
        methods = {name: name + form if name + form in METHODS else name for name in OF_THESIS}
        return {
            method: agreement(find(results, method, case, **world), PRINTED[name], reading)
            for name, method in methods.items()
        }

    def share_of_table(answers: Mapping[str, list[bool]]) -> Estimate:
        return share_of(np.ravel(list(answers.values())))

    measured: dict[str, Estimate] = {}
    for case in CASES_SHOWN:
        for form in ("", ", printed"):
            answers = whole_table(case, form)
            measured |= {f"agree_{name_of(method, case)}": share_of(inside) for method, inside in answers.items()}
            measured[f"agree_all{form.replace(', ', '_')}_{case}"] = share_of_table(answers)
        for name in METHODS:
            last = regrets(find(results, name, case), DEFAULT_READING, AFTER[-1])
            measured[f"deviation_{AFTER[-1]}_{name_of(name, case)}"] = grouped_deviation(last)
    measured["agree_BE_near_greedy_exact"] = share_of(agreement(find(results, "BE, κ 30", "exact"), PRINTED["BE"]))
    for reading in READINGS:
        answers = whole_table("exact", reading=reading)
        measured[f"agree_all_{reading.replace(' ', '_')}"] = share_of_table(answers)
    other = next(noise for noise in NOISES if noise != DEFAULT_WORLD["noise"])
    ways = [(case, form, {}) for case in CASES_SHOWN for form in ("", ", printed")]
    ways += [("exact", form, {"noise": other}) for form in ("", ", printed")]
    patterns = [
        late_pattern(results, case, form, reading, **world) for case, form, world in ways for reading in READINGS
    ]
    measured["grid_late_pattern"] = share_of(patterns)
    return measured | {"agree_all_other_noise": share_of_table(whole_table("exact", noise=other))}


def late_pattern(results: Sequence[Mapping], case: str, form: str, reading: str, **world: str) -> bool:
    """Whether regret after the last episode varies little with the rules that converge and much with the others.

    For certain, in the rules' printed forms where `form` is ", printed" and they have one.
    """

    def deviation(name: str) -> Estimate:
        method = name + form if name + form in METHODS else name
        return grouped_deviation(regrets(find(results, method, case, **world), reading, AFTER[-1]))

    small = all(is_below(deviation(name), SMALL) for name in SMALL_LATE)
    return small and all(is_above(deviation(name), LARGE) for name in LARGE_LATE)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a cell and reading: quantiles of the groups' deviations after each printed episode."""
    found = []
    for result in results:
        for reading in READINGS:
            row = {key: result[key] for key in ("method", "case", "noise")}
            quantiles = [np.quantile(deviations(result, reading, k), [0.025, 0.5, 0.975]) for k in AFTER]
            found.append({**row, "reading": reading, "quantiles": np.round(quantiles, 2).tolist()})
    return found
