"""Measures and rows of claim C2.2."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.relations import CORE_RELATIONS
from lifelore.core.streams import stream
from lifelore.experiments.chapter2.c2_01_nearest_displacements.measure import data_sets
from lifelore.experiments.chapter2.pair_validation import Reading, Told, displacements, vote
from lifelore.experiments.chapter2.relation_scoring import BESIDE, CARRIED
from lifelore.experiments.chapter2.tabletop_pairs import KERNELS, Row, kernel_name

COMPONENTS = {"on": CARRIED, "adjacent": BESIDE}


def component_answers(told: Told, truth: NDArray[np.str_], agree: float) -> dict[str, dict[str, float]]:
    """Of each component over the displacements told: shares right, of its more frequent value, and in agreement.

    Neighbours vote on each component by itself; the component is there where at least half of them say so.
    """
    found = {}
    for name, classes in COMPONENTS.items():
        has = told.shares[:, [CORE_RELATIONS.index(one) for one in sorted(classes)]].sum(axis=1)
        said, true = has >= 0.5, np.isin(truth[told.row], sorted(classes))
        with_said = np.where(said, has, 1 - has)
        found[name] = {
            "right": float((said == true).mean()),
            "majority": float(max(true.mean(), 1 - true.mean())),
            "agreement": float((with_said >= agree - 1e-9).mean()),
        }
    return found


def split_answers(settings: Mapping, rows: Sequence[Row], reading: Reading, splits: int, name: str) -> dict:
    """Means over random splits of one data set by scene: of each component, and displacements told."""
    each = [displacements(row, reading.kernel, reading.drop) for row in rows]
    owner = np.repeat(np.arange(len(rows)), [len(one) for one in each])
    moved, truth = np.concatenate(each), np.array([row["relation"] for row in rows])
    scenes = sorted({row["scene"] for row in rows})
    n_test = max(1, round(len(scenes) * settings["test"] / settings["pairs"]))
    answers = []
    for number in range(splits):
        chosen = set(stream(number, "C2.2", name).choice(scenes, n_test, replace=False))
        train = np.array([row["scene"] not in chosen for row in rows])
        told = vote(moved, owner, rows, reading, train)
        if len(told.row):
            answers.append({"told": len(told.row)} | component_answers(told, truth, settings["agree"]))
    means = {"told": float(np.mean([answer["told"] for answer in answers])), "displacements": len(moved)}
    for component in COMPONENTS:
        for key in ("right", "majority", "agreement"):
            means[f"{component}_{key}"] = float(np.mean([answer[component][key] for answer in answers]))
    return means


def _by_set(settings: Mapping, results: Sequence[Mapping], reading: Reading, splits: int) -> dict[str, dict]:
    return {
        str(name): split_answers(settings, rows, reading, splits, str(name))
        for name, rows in data_sets(results).items()
    }


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Means over splits; intervals over data sets, since splits of one share its pictures."""
    found = _by_set(settings, results, Reading(), settings["splits"])
    simulated = [means for name, means in found.items() if name != "real"]

    def over_sets(number: Callable[[Mapping], float]) -> Estimate:
        return mean_estimate([number(means) for means in simulated])

    measured = {"relationships_a_picture": over_sets(lambda m: m["displacements"] / settings["pairs"])}
    for name in COMPONENTS:
        measured[f"{name}_right"] = over_sets(lambda m, name=name: m[f"{name}_right"])
        measured[f"{name}_majority"] = over_sets(lambda m, name=name: m[f"{name}_majority"])
        measured[f"{name}_right_less_majority"] = over_sets(
            lambda m, name=name: m[f"{name}_right"] - m[f"{name}_majority"]
        )
        measured[f"{name}_agreement"] = over_sets(lambda m, name=name: m[f"{name}_agreement"])
    measured["agreement_on_less_adjacent"] = over_sets(lambda m: m["on_agreement"] - m["adjacent_agreement"])
    if "real" in found:
        for key in ("on_right", "on_majority", "adjacent_right", "adjacent_majority"):
            measured[f"{key}_real"] = Estimate(found["real"][key], found["real"][key], None, settings["splits"])
    return measured


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Means by data set at the standard kernel, then by kernel over fewer splits."""
    found = [
        {"data_set": name, **means}
        for name, means in _by_set(settings, results, Reading(), settings["splits"]).items()
    ]
    for kernel in KERNELS:
        reading = Reading(kernel_name(*kernel))
        of_sets = _by_set(settings, results, reading, max(1, settings["splits"] // 10))
        found += [{"kernel": reading.kernel, "data_set": name, **means} for name, means in of_sets.items()]
    return found
