"""Claim C2.2: the two components of a label over random splits of each data set (§2.4.1)."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.core.relations import CORE_RELATIONS
from lifelore.core.streams import stream
from lifelore.experiments.chapter2.scenes import tabletop_pairs
from lifelore.experiments.chapter2.scenes.tabletop_pairs import KERNELS, Row, data_sets, kernel_name
from lifelore.experiments.chapter2.scoring.pair_validation import Reading, Votes, joined_displacements, votes_on
from lifelore.experiments.chapter2.scoring.relation_scoring import BESIDE, CARRIED
from lifelore.experiments.engine.results_table import ResultsTable, computed_once

COMPONENTS = {"on": CARRIED, "adjacent": BESIDE}
MEASURES = ("right", "majority", "right_less_majority", "agreement")
cells, run_cell = tabletop_pairs.pair_cells, tabletop_pairs.run_cell


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Means over splits; intervals over simulated data sets, since the splits of a set share its pictures."""
    records = [
        row
        | {f"{name}_right_less_majority": row[f"{name}_right"] - row[f"{name}_majority"] for name in COMPONENTS}
        | {"agreement_on_less_adjacent": row["on_agreement"] - row["adjacent_agreement"]}
        for row in at_standard_kernel(settings, results)
        if row["data_set"] != "real"
    ]
    names = [f"{name}_{key}" for name in COMPONENTS for key in MEASURES]
    table = ResultsTable(records, ("data_set",))
    return {name: table.mean(name) for name in (*names, "agreement_on_less_adjacent")}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Means by data set at the standard kernel, then by kernel over fewer splits."""
    found, splits = [*at_standard_kernel(settings, results)], max(1, settings["splits"] // 10)
    for kernel in (kernel_name(*kernel) for kernel in KERNELS):
        found += [{"kernel": kernel, **row} for row in by_data_set(settings, results, Reading(kernel), splits)]
    return found


@computed_once
def at_standard_kernel(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """`by_data_set` over all splits."""
    return by_data_set(settings, results, Reading(), settings["splits"])


def by_data_set(settings: Mapping, results: Sequence[Mapping], reading: Reading, splits: int) -> list[dict]:
    """``{"data_set", **split_answers}`` of each data set."""
    sets = {str(name): pairs for name, pairs in data_sets(results).items()}
    return [
        {"data_set": name, **split_answers(settings, rows, reading, splits, name)} for name, rows in sets.items()
    ]


def split_answers(settings: Mapping, rows: Sequence[Row], reading: Reading, splits: int, name: str) -> dict:
    """Means over random splits of a data set by scene: shares of each component, and displacements classified."""
    moved, owner = joined_displacements(rows, reading.kernel, reading.drop)
    truth = np.array([row["relation"] for row in rows])
    scenes = sorted({row["scene"] for row in rows})
    n_test = max(1, round(len(scenes) * settings["test"] / settings["pairs"]))
    answers = []
    for number in range(splits):
        chosen = set(stream(number, "C2.2", name).choice(scenes, n_test, replace=False))
        train = np.array([row["scene"] not in chosen for row in rows])
        votes = votes_on(moved, owner, rows, reading, train)
        if len(votes.row):
            answers.append({"told": len(votes.row)} | component_answers(votes, truth, settings["agree"]))
    means = {key: float(np.mean([answer[key] for answer in answers])) for key in answers[0]}
    return {"told": means.pop("told"), "displacements": len(moved), **means}


def component_answers(votes: Votes, truth: NDArray[np.str_], agree: float) -> dict[str, float]:
    """Of each component over the displacements: shares right, of its more frequent value, and in agreement.

    Neighbours vote on each component by itself; the component is predicted where at least half of them have it.
    """
    found = {}
    for name, classes in COMPONENTS.items():
        has = votes.shares[:, [CORE_RELATIONS.index(label) for label in sorted(classes)]].sum(axis=1)
        predicted, true = has >= 0.5, np.isin(truth[votes.row], sorted(classes))
        found[f"{name}_right"] = float((predicted == true).mean())
        found[f"{name}_majority"] = float(max(true.mean(), 1 - true.mean()))
        found[f"{name}_agreement"] = float((np.where(predicted, has, 1 - has) >= agree - 1e-9).mean())
    return found
