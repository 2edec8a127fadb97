"""C2.12: the displacements between contact points clustered by X-means, without labels (§2.3.5).

All displacements between the contact points of a pair take part, A and B in the order given, as with labels. The
thesis states neither the space (three dimensions, or the plane of Figure 2.4) nor the kernel.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.core.relations import ADJACENT, BOTH, CORE_RELATIONS, ON
from lifelore.core.streams import stream
from reproduction.chapter2.c2_12_unlabelled_relations.x_means import x_means
from reproduction.chapter2.scenes import tabletop_pairs
from reproduction.chapter2.scenes.tabletop_pairs import Row, simulated_sets
from reproduction.chapter2.scoring.pair_validation import CONTACT_READINGS, Reading, joined_displacements
from reproduction.engine.estimates import mean_or_unmeasured

MOST = 10
"""Most clusters that may be found."""
SPACES = {"three dimensions": [0, 1, 2], "plane of Figure 2.4": [0, 2]}
"""Columns of a displacement that are clustered."""
cells, run_cell, shared = tabletop_pairs.pair_cells, tabletop_pairs.run_cell, tabletop_pairs.SETTINGS_OF_A_CELL
Labels = NDArray[np.int64]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The measures over the data sets at the default."""
    return measures(simulated_sets(results), Reading(), "three dimensions", settings["starts"])


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The measures for every kernel, threshold and space."""
    for reading, space in product(CONTACT_READINGS, SPACES):
        head = {"kernel": reading.kernel, "threshold": reading.threshold, "space": space}
        yield head, measures(simulated_sets(results), reading, space, settings["starts"])


def measures(sets: Sequence[Sequence[Row]], reading: Reading, space: str, starts: int) -> dict[str, Estimate]:
    """Means over data sets of the agreement of clusters with relations, and of how *on* and *adjacent* blur."""
    found: dict[str, list[float]] = {"agreement": [], "clusters": [], "blurred": []}
    for number, rows in enumerate(sets):
        moved, relations = joined(rows, reading, space)
        if len(moved) < MOST:
            continue
        for start in range(starts):
            rng = stream(start, "relation clusters", number)
            labels = x_means(moved, rng, most=MOST).labels
            found["agreement"].append(rand_index(relations, labels))
            found["clusters"].append(float(len(set(labels))))
            found["blurred"].append(blurred(relations, labels))
    sized = {name: np.reshape(values, (-1, starts)).mean(axis=1) for name, values in found.items()}
    return {name: mean_or_unmeasured(values[np.isfinite(values)]) for name, values in sized.items()}


def joined(rows: Sequence[Row], reading: Reading, space: str) -> tuple[NDArray[np.float64], NDArray[np.str_]]:
    """All displacements of a data set in a space, and the relation of the pair of each."""
    moved, owner = joined_displacements(rows, reading.kernel, reading.threshold)
    return np.ascontiguousarray(moved[:, SPACES[space]]), np.array([row["relation"] for row in rows])[owner]


def rand_index(relations: NDArray[np.str_], labels: Labels) -> float:
    """Adjusted Rand index: 1 where clusters are the relations, 0 as good as chance."""
    from sklearn.metrics import adjusted_rand_score

    return float(adjusted_rand_score(relations, labels))


def blurred(relations: NDArray[np.str_], labels: Labels) -> float:
    """Share of *both* displacements in clusters that are mostly *on* or *adjacent*; NaN without any."""
    own = np.array([mostly(relations[labels == k]) for k in labels[relations == BOTH]])
    return float(np.isin(own, [ON, ADJACENT]).mean()) if len(own) else float("nan")


def mostly(relations: NDArray[np.str_]) -> str:
    """The most frequent relation; among equals the first of `CORE_RELATIONS`."""
    return max(CORE_RELATIONS, key=lambda name: int((relations == name).sum()))
