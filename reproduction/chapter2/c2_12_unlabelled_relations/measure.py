"""Claim C2.12: clusters of pairs by method and data set, and how well they agree with the labels (§2.3.5)."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.core.relations import ADJACENT, BOTH, ON
from reproduction.chapter2.c2_12_unlabelled_relations.relation_clusters import (
    K_MEANS,
    METHODS,
    OURS,
    X_MEANS,
    Labels,
    Sighted,
    cluster_counts,
    cluster_names,
    clustered,
    every_word,
    rand_index,
    rand_index_by_scene,
    sighted,
)
from reproduction.chapter2.scenes import tabletop_pairs
from reproduction.chapter2.scenes.tabletop_pairs import KERNELS, data_sets, kernel_name
from reproduction.chapter2.scoring.pair_validation import DROPS, Reading
from reproduction.engine.estimates import UNMEASURED
from reproduction.engine.results_table import computed_once

REAL = "real"
cells, run_cell, shared = tabletop_pairs.pair_cells, tabletop_pairs.run_cell, tabletop_pairs.SETTINGS_OF_A_CELL
Clustered = tuple[Sighted, dict[str, list[Labels]]]
"""The near pairs of a data set, and by method their clusters from each start."""


@computed_once
def clusters(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Clustered]:
    """By data set; sets without a near pair are left out."""
    found = {}
    for name, rows in data_sets(results).items():
        if any(row["gap"] is not None for row in rows):
            seen = sighted(rows)
            by_method = {method: clustered(seen, method, settings["starts"], str(name)) for method in METHODS}
            found[str(name)] = seen, by_method
    return found


def underscored(method: str) -> str:
    """A method as part of a measure's name."""
    return method.replace(", ", "_").replace("-", "_")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Clusters of X-means, the adjusted Rand index (ARI) of each method, simulated and real; and *both*."""
    found = clusters(settings, results)
    simulated = [clustered_set for name, clustered_set in found.items() if name != REAL]
    indices = {method: [rand_indices(own, method) for own in simulated] for method in METHODS}
    measured = {f"ari_{underscored(method)}": mean_estimate(values) for method, values in indices.items()}
    numbers = [np.mean([len(set(labels)) for labels in by_method[X_MEANS]]) for _, by_method in simulated]
    measured["clusters_x_means"] = mean_estimate(numbers)
    measured["ari_x_means_less_k_means"] = mean_estimate(np.subtract(indices[X_MEANS], indices[K_MEANS]))
    measured["both_in_a_cluster_of_both"] = both_in_a_cluster_of_both(simulated)
    measured |= sides(simulated)
    if REAL in found:
        seen, by_method = found[REAL]
        for method, starts in by_method.items():
            index = rand_index_by_scene(seen.scenes, seen.relations, starts[0])
            measured[f"ari_{underscored(method)}_{REAL}"] = index
    return measured


def rand_indices(found: Clustered, method: str) -> float:
    """Adjusted Rand index of a data set, mean over starts."""
    seen, by_method = found
    return float(np.mean([rand_index(seen.relations, labels) for labels in by_method[method]]))


def both_in_a_cluster_of_both(sets: Sequence[Clustered]) -> Estimate:
    """Share of *both* pairs in clusters of X-means whose most frequent relation is *both*; mean over starts."""
    all_both = [int((seen.relations == BOTH).sum()) for seen, _ in sets]
    inside = []
    for seen, by_method in sets:
        named = [cluster_names(seen.relations, labels) == BOTH for labels in by_method[X_MEANS]]
        inside.append(float(np.mean([(inside_both & (seen.relations == BOTH)).sum() for inside_both in named])))
    return ratio_estimate(inside, all_both) if sum(all_both) else UNMEASURED


def sides(sets: Sequence[Clustered]) -> dict[str, Estimate]:
    """ARI of X-means with left and right as relations of their own: of all pairs; of *on* and *adjacent* alone."""
    apart, alone = [], []
    for seen, by_method in sets:
        core = np.isin(seen.relations, [ON, ADJACENT])
        apart.append(np.mean([rand_index(seen.sides, labels) for labels in by_method[X_MEANS]]))
        if core.any():
            alone.append(np.mean([rand_index(seen.sides[core], labels[core]) for labels in by_method[X_MEANS]]))
    return {
        "ari_x_means_left_and_right_apart": mean_estimate(apart),
        "ari_x_means_of_on_left_and_right_alone": mean_estimate(alone) if alone else UNMEASURED,
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Clusters by relation of every data set and method; results with all displacements, by kernel; the points."""
    found = clusters(settings, results)
    rows: list[dict] = []
    for name, (seen, by_method) in found.items():
        for method, starts in by_method.items():
            row = {"data_set": name, "method": method, "pairs": len(seen.relations)}
            row["ari"] = [round(rand_index(seen.relations, labels), 4) for labels in starts]
            rows.append(row | {"relations of clusters": cluster_counts(seen.relations, starts[0])})
    if settings["grid"]:
        rows += every_word_rows(results)
    for seen, by_method in list(found.values())[:1]:
        shown = {method: by_method[method][0].tolist() for method in (X_MEANS, K_MEANS, OURS)}
        at = np.round(1000 * seen.displacements, 1).tolist()
        rows.append({"displacements": at, "relations": seen.relations.tolist(), "clusters": shown})
    return rows


def every_word_rows(results: Sequence[Mapping]) -> list[dict]:
    """All displacements clustered as the thesis literally says, by kernel, dropping of contacts and data set."""
    found = []
    for kernel, drop in product((kernel_name(*kernel) for kernel in KERNELS), DROPS):
        for name, rows in data_sets(results).items():
            numbers = every_word(rows, Reading(kernel, drop), str(name))
            if numbers:
                shares = {key: round(numbers[key], 4) for key in ("ari_x_means", "ari_k_means")}
                found.append({"every word": kernel, "drop": drop, "data_set": str(name), **numbers, **shares})
    return found
