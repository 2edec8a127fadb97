"""Claim C2.2: the two components of a label over random splits of each data set (§2.4.1)."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.core.relations import CORE_RELATIONS
from lifelore.core.streams import stream
from reproduction.chapter2.scenes import tabletop_pairs
from reproduction.chapter2.scenes.tabletop_pairs import KERNELS, Row, data_sets, kernel_name
from reproduction.chapter2.scoring.pair_validation import (
    AS_PRINTED,
    DROPS,
    Reading,
    Votes,
    joined_displacements,
    votes_on,
)
from reproduction.chapter2.scoring.relation_scoring import BESIDE, CARRIED
from reproduction.engine.estimates import UNMEASURED, is_above, mean_or_unmeasured, share_of
from reproduction.engine.results_table import ResultsTable, computed_once

COMPONENTS = {"on": CARRIED, "adjacent": BESIDE}
SHARES = ("right", "majority", "agreement")
MEASURES = ("right", "majority", "right_less_majority", "agreement")
cells, run_cell, shared = tabletop_pairs.pair_cells, tabletop_pairs.run_cell, tabletop_pairs.SETTINGS_OF_A_CELL


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Means over splits; intervals over simulated data sets, since the splits of a set share its pictures.

    Then the shares right as printed, where contacts of fewer than seven support vectors are dropped: of the
    relationships that are left, and of all. Last the share of readings in which both components beat their
    majority by their intervals.
    """
    names = [f"{name}_{key}" for name in COMPONENTS for key in MEASURES]
    found = means(at_standard_kernel(settings, results), (*names, "agreement_on_less_adjacent"))
    grid = over_grid(settings, results)
    as_printed = means(grid[AS_PRINTED], [f"{name}_right" for name in COMPONENTS])
    found |= {f"{name}_as_printed": number for name, number in as_printed.items()}
    found |= of_all_as_printed(settings, results)
    gains = [f"{name}_right_less_majority" for name in COMPONENTS]
    beaten = [all(is_above(number, 0) for number in means(rows, gains).values()) for rows in grid.values()]
    return found | {"readings_in_which_both_beat_their_majority": share_of(beaten)}


def of_all_as_printed(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Means of `right_of_all` as printed over simulated data sets, in the splits of `over_grid`."""
    simulated = {str(name): pairs for name, pairs in data_sets(results).items() if name != "real"}
    splits = splits_of_grid(settings)
    shares = [right_of_all(settings, rows, AS_PRINTED, splits, name) for name, rows in simulated.items()]
    return {
        f"{name}_right_of_all_as_printed": mean_or_unmeasured(share[name] for share in shares)
        for name in COMPONENTS
    }


def means(rows: Sequence[Mapping], names: Sequence[str]) -> dict[str, Estimate]:
    """Means of some measures over the simulated data sets of `by_data_set`."""
    records = [
        dict(row)
        | {f"{name}_right_less_majority": row[f"{name}_right"] - row[f"{name}_majority"] for name in COMPONENTS}
        | {"agreement_on_less_adjacent": row["on_agreement"] - row["adjacent_agreement"]}
        for row in rows
        if row["data_set"] != "real"
    ]
    table = ResultsTable(records, ("data_set",))
    return {name: table.mean(name) if records else UNMEASURED for name in names}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Means by data set at the standard kernel; then by reading, over fewer splits, simulated sets in a row."""
    found = [*at_standard_kernel(settings, results)]
    for reading, by_set in over_grid(settings, results).items():
        head = {"kernel": reading.kernel, "drop": reading.drop}
        names = ["told", "displacements", *(f"{name}_{key}" for name in COMPONENTS for key in SHARES)]
        numbers = {name: number.value for name, number in means(by_set, names).items()}
        found.append({**head, "data_set": "simulated", **numbers})
        found += [{**head, **row} for row in by_set if row["data_set"] == "real"]
    return found


@computed_once
def over_grid(settings: Mapping, results: Sequence[Mapping]) -> dict[Reading, list[dict]]:
    """`by_data_set` for every kernel and every treatment of weak contacts, over a tenth of the splits."""
    splits = splits_of_grid(settings)
    kernels = [kernel_name(*kernel) for kernel in KERNELS]
    readings = [Reading(kernel, drop) for kernel, drop in product(kernels, DROPS)]
    return {reading: by_data_set(settings, results, reading, splits) for reading in readings}


def splits_of_grid(settings: Mapping) -> int:
    """Random splits of a data set in each reading of the grid."""
    return max(1, settings["splits"] // 10)


@computed_once
def at_standard_kernel(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """`by_data_set` over all splits."""
    return by_data_set(settings, results, Reading(), settings["splits"])


def by_data_set(settings: Mapping, results: Sequence[Mapping], reading: Reading, splits: int) -> list[dict]:
    """``{"data_set", **split_answers}`` of each data set in which something is classified."""
    sets = {str(name): pairs for name, pairs in data_sets(results).items()}
    answers = {name: split_answers(settings, rows, reading, splits, name) for name, rows in sets.items()}
    return [{"data_set": name, **found} for name, found in answers.items() if found]


def split_answers(settings: Mapping, rows: Sequence[Row], reading: Reading, splits: int, name: str) -> dict:
    """Means over random splits of a data set by scene: shares of each component, and displacements classified.

    Empty where no test scene of any split has a displacement.
    """
    truth = np.array([row["relation"] for row in rows])
    answers = [
        {"told": len(votes.row)} | component_answers(votes, truth, settings["agree"])
        for _, votes in split_votes(settings, rows, reading, splits, name)
        if len(votes.row)
    ]
    if not answers:
        return {}
    found = {key: float(np.mean([answer[key] for answer in answers])) for key in answers[0]}
    n = len(joined_displacements(rows, reading.kernel, reading.drop)[0])
    return {"told": found.pop("told"), "displacements": n, **found}


def right_of_all(settings: Mapping, rows: Sequence[Row], reading: Reading, splits: int, name: str) -> dict:
    """Means over random splits: the share of all test relationships that is right, for each component.

    A test pair that has no displacement counts as one relationship, which is wrong.
    """
    truth = np.array([row["relation"] for row in rows])
    found: dict[str, list[float]] = {component: [] for component in COMPONENTS}
    for test, votes in split_votes(settings, rows, reading, splits, name):
        untold = len(set(np.flatnonzero(test)) - set(votes.row))
        for component, classes in COMPONENTS.items():
            _, predicted, true = judged_component(votes, truth, classes)
            found[component].append(float((predicted == true).sum() / (len(true) + untold)))
    return {component: float(np.mean(shares)) for component, shares in found.items()}


def split_votes(
    settings: Mapping, rows: Sequence[Row], reading: Reading, splits: int, name: str
) -> Iterator[tuple[NDArray[np.bool_], Votes]]:
    """Random splits of a data set by scene: which rows are tested, and the votes on their displacements."""
    moved, owner = joined_displacements(rows, reading.kernel, reading.drop)
    scenes = sorted({row["scene"] for row in rows})
    n_test = max(1, round(len(scenes) * settings["test"] / settings["pairs"]))
    for number in range(splits):
        chosen = set(stream(number, "C2.2", name).choice(scenes, n_test, replace=False))
        test = np.array([row["scene"] in chosen for row in rows])
        yield test, votes_on(moved, owner, rows, reading, ~test)


def component_answers(votes: Votes, truth: NDArray[np.str_], agree: float) -> dict[str, float]:
    """Of each component over the displacements: shares right, of its more frequent value, and in agreement."""
    found = {}
    for name, classes in COMPONENTS.items():
        has, predicted, true = judged_component(votes, truth, classes)
        found[f"{name}_right"] = float((predicted == true).mean())
        found[f"{name}_majority"] = float(max(true.mean(), 1 - true.mean()))
        found[f"{name}_agreement"] = float((np.where(predicted, has, 1 - has) >= agree - 1e-9).mean())
    return found


def judged_component(
    votes: Votes, truth: NDArray[np.str_], classes: Collection[str]
) -> tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_]]:
    """Of a component over the displacements: the share of neighbours with it, and whether it is said and true.

    Neighbours vote on each component by itself; the component is predicted where at least half of them have it.
    """
    has = votes.shares[:, [CORE_RELATIONS.index(label) for label in sorted(classes)]].sum(axis=1)
    return has, has >= 0.5, np.isin(truth[votes.row], sorted(classes))
