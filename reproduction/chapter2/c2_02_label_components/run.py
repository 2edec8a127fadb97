"""C2.2: the two components of a label over random splits into 95 and 33 pictures (§2.4.1).

Each displacement between contact points is one relationship, as the thesis counts them. A pair without a
displacement is one relationship, which is wrong in both components.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.core.relations import CORE_RELATIONS
from lifelore.core.streams import stream
from reproduction.chapter2.scenes import tabletop_pairs
from reproduction.chapter2.scenes.tabletop_pairs import Row, simulated_sets
from reproduction.chapter2.scoring.pair_validation import CONTACT_READINGS, Reading, joined_displacements, votes_on
from reproduction.chapter2.scoring.relation_scoring import BESIDE, CARRIED
from reproduction.engine.estimates import mean_or_unmeasured

COMPONENTS = {"on": CARRIED, "adjacent": BESIDE}
cells, run_cell, shared = tabletop_pairs.pair_cells, tabletop_pairs.run_cell, tabletop_pairs.SETTINGS_OF_A_CELL


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Means over splits; intervals over simulated data sets, since the splits of a set share its pictures."""
    return means(settings, results, Reading(), settings["splits"])


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The same for every kernel and threshold, over a tenth of the splits."""
    for reading in CONTACT_READINGS:
        found = means(settings, results, reading, max(1, settings["splits"] // 10))
        yield {"kernel": reading.kernel, "threshold": reading.threshold}, found


def means(settings: Mapping, results: Sequence[Mapping], reading: Reading, splits: int) -> dict[str, Estimate]:
    """Means of `component_answers` over the splits of each data set, then over data sets."""
    sets = [
        split_answers(settings, rows, reading, splits, str(number))
        for number, rows in enumerate(simulated_sets(results))
    ]
    return {name: mean_or_unmeasured(own[name] for own in sets) for name in sets[0]}


def split_answers(
    settings: Mapping, rows: Sequence[Row], reading: Reading, splits: int, name: str
) -> dict[str, float]:
    """Means over random splits of a data set called `name`; all displacements of a scene are on one side."""
    moved, owner = joined_displacements(rows, reading.kernel, reading.threshold)
    relations = np.array([row["relation"] for row in rows])
    scenes = sorted({row["scene"] for row in rows})
    n_test = min(max(1, round(len(scenes) * settings["test"] / settings["pairs"])), len(scenes))
    found = []
    for number in range(splits):
        chosen = set(stream(number, "C2.2", name).choice(scenes, n_test, replace=False))
        test = np.array([row["scene"] in chosen for row in rows])
        votes = votes_on(moved, owner, rows, reading, ~test)
        lost = np.setdiff1d(np.flatnonzero(test), votes.row)
        found.append(component_answers(votes.shares, relations[votes.row], relations[lost], settings["agree"]))
    return {key: float(np.mean([one[key] for one in found])) for key in found[0]}


def component_answers(
    shares: NDArray[np.float64], relations: NDArray[np.str_], lost: NDArray[np.str_], agree: float
) -> dict[str, float]:
    """Of each component: shares of relationships that are right, and in agreement with enough neighbours.

    `shares` ``(m, 4)`` of the neighbours have each of `CORE_RELATIONS`; `relations` ``(m,)`` are true, and `lost`
    those of pairs without a displacement. Neighbours vote on each component by itself; it is predicted where at
    least half of them have it. ``…_less_majority`` is the gain over the component's more frequent value.
    """
    found, n = {}, len(relations) + len(lost)
    for name, classes in COMPONENTS.items():
        has = shares[:, _columns(classes)].sum(axis=1)
        predicted, true = has >= 0.5, np.isin(relations, sorted(classes))
        rate = (true.sum() + np.isin(lost, sorted(classes)).sum()) / n
        found[f"{name}_right"] = float((predicted == true).sum() / n)
        found[f"{name}_less_majority"] = found[f"{name}_right"] - float(max(rate, 1 - rate))
        found[f"{name}_agreement"] = float((np.where(predicted, has, 1 - has) >= agree - 1e-9).sum() / n)
    found["agreement_on_less_adjacent"] = found["on_agreement"] - found["adjacent_agreement"]
    return found


def _columns(classes: Collection[str]) -> list[int]:
    return [CORE_RELATIONS.index(label) for label in sorted(classes)]
