"""Measures and rows of claim C2.12."""

import json
from collections.abc import Mapping, Sequence
from functools import lru_cache
from itertools import product

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.core.relations import ADJACENT, BOTH, CORE_RELATIONS, ON
from lifelore.experiments.chapter2.c2_01_nearest_displacements.measure import data_sets
from lifelore.experiments.chapter2.c2_12_unlabelled_relations.relation_clusters import (
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
    macro_f1,
    rand_index,
    rand_index_by_scene,
    sighted,
)
from lifelore.experiments.chapter2.pair_validation import DROPS, Reading
from lifelore.experiments.chapter2.tabletop_pairs import KERNELS, kernel_name
from lifelore.experiments.engine.cell_store import canonical
from lifelore.experiments.engine.estimates import UNMEASURED

REAL = "real"
Found = dict[str, tuple[Sighted, dict[str, list[Labels]]]]


@lru_cache(maxsize=2)
def _found(starts: int, results: str) -> Found:
    """By data set its near pairs, and by method their clusters from each start; kept, since all ask."""
    found = {}
    for name, rows in data_sets(json.loads(results)).items():
        if any(row["gap"] is not None for row in rows):
            seen = sighted(rows)
            found[str(name)] = seen, {method: clustered(seen, method, starts, str(name)) for method in METHODS}
    return found


def under(method: str) -> str:
    return method.replace(", ", "_").replace("-", "_")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Of each method the clusters found and their agreement, simulated and real; then the thesis word by word."""
    found = _found(settings["starts"], canonical(list(results)))
    simulated = [one for name, one in found.items() if name != REAL]
    measured: dict[str, Estimate] = {}
    for method in METHODS:
        measured |= agreement([(seen, labels[method]) for seen, labels in simulated], under(method))
    ours, told = (_rand_indices(simulated, method) for method in (X_MEANS, K_MEANS))
    measured["ari_x_means_less_k_means"] = mean_estimate(np.subtract(ours, told))
    measured |= _sides(simulated)
    if REAL in found:
        measured |= _real(*found[REAL])
    return measured | _every_word(results)


def _rand_indices(sets: Sequence[tuple[Sighted, Mapping[str, list[Labels]]]], method: str) -> list[float]:
    return [float(np.mean([rand_index(seen.relations, one) for one in labels[method]])) for seen, labels in sets]


def agreement(sets: Sequence[tuple[Sighted, list[Labels]]], method: str) -> dict[str, Estimate]:
    """Over data sets: clusters, adjusted Rand index, and where pairs lie when clusters take their commonest name.

    ``R_in_a_cluster_of_R``: the share of pairs of a relation R in clusters of that name, its recall; of *both*
    also where else.
    """
    named = [[cluster_names(seen.relations, one) for one in labels] for seen, labels in sets]
    found = {
        f"clusters_{method}": mean_estimate([np.mean([len(set(one)) for one in labels]) for _, labels in sets]),
        f"ari_{method}": mean_estimate(
            [np.mean([rand_index(seen.relations, one) for one in labels]) for seen, labels in sets]
        ),
        f"macro_f1_{method}": mean_estimate(
            [
                np.mean([macro_f1(seen.relations, one) for one in each])
                for (seen, _), each in zip(sets, named, strict=True)
            ]
        ),
    }
    ends = "" if method == under(X_MEANS) else f"_{method}"
    for true, said in [(name, name) for name in CORE_RELATIONS] + [(BOTH, ON), (BOTH, ADJACENT)]:
        of = [int((seen.relations == true).sum()) for seen, _ in sets]
        into = [
            float(np.mean([((seen.relations == true) & (one == said)).sum() for one in each]))
            for (seen, _), each in zip(sets, named, strict=True)
        ]
        if sum(of) or true == BOTH:
            found[f"{true}_in_a_cluster_of_{said}{ends}"] = ratio_estimate(into, of) if sum(of) else UNMEASURED
    return found


def _sides(sets: Sequence[tuple[Sighted, Mapping[str, list[Labels]]]]) -> dict[str, Estimate]:
    """X-means asked for less: left and right may be relations of their own; of *on* and *adjacent* alone."""
    apart, alone = [], []
    for seen, labels in sets:
        core = np.isin(seen.relations, [ON, ADJACENT])
        apart.append(np.mean([rand_index(seen.sides, one) for one in labels[X_MEANS]]))
        if core.any():
            alone.append(np.mean([rand_index(seen.sides[core], one[core]) for one in labels[X_MEANS]]))
    return {
        "ari_x_means_left_and_right_apart": mean_estimate(apart),
        "ari_x_means_of_on_left_and_right_alone": mean_estimate(alone) if alone else UNMEASURED,
    }


def _real(seen: Sighted, labels: Mapping[str, list[Labels]]) -> dict[str, Estimate]:
    found = {}
    for method, starts in labels.items():
        place = f"{under(method)}_{REAL}"
        clusters = [len(set(one)) for one in starts]
        found[f"clusters_{place}"] = Estimate(
            float(np.mean(clusters)), float(np.median(clusters)), None, len(clusters)
        )
        found[f"ari_{place}"] = rand_index_by_scene(seen.scenes, seen.relations, starts[0])
        named = cluster_names(seen.relations, starts[0])
        score = macro_f1(seen.relations, named)
        found[f"macro_f1_{place}"] = Estimate(score, score, None, len(named))
    return found


def _every_word(results: Sequence[Mapping]) -> dict[str, Estimate]:
    each = [
        every_word(rows, Reading(), str(name)) for name, rows in data_sets(results).items() if str(name) != REAL
    ]
    told = [one for one in each if one]
    if not told:
        return {}
    return {
        f"{key}_every_word": mean_estimate([one[key] for one in told])
        for key in ("clusters", "ari_x_means", "ari_k_means")
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Clusters by relation, of every data set and method; the first set's displacements; kernels, word by word."""
    found = _found(settings["starts"], canonical(list(results)))
    rows: list[dict] = []
    for name, (seen, labels) in found.items():
        for method, starts in labels.items():
            row = {"data_set": name, "method": method, "pairs": len(seen.relations)}
            row["ari"] = [round(rand_index(seen.relations, one), 4) for one in starts]
            rows.append(row | {"relations of clusters": cluster_counts(seen.relations, starts[0])})
    first = next(iter(found.values()), None)
    grid = _every_word_rows(results) if settings["grid"] else []
    return rows + grid + ([_points(*first)] if first else [])


def _points(seen: Sighted, labels: Mapping[str, list[Labels]]) -> dict:
    """What the figure scatters: displacements in mm, relations, and the clusters of three methods."""
    shown = {method: labels[method][0].tolist() for method in (X_MEANS, K_MEANS, OURS)}
    at = np.round(1000 * seen.displacements, 1).tolist()
    return {"displacements": at, "relations": seen.relations.tolist(), "clusters": shown}


def _every_word_rows(results: Sequence[Mapping]) -> list[dict]:
    sets = data_sets(results)
    found = []
    for kernel, drop in product((kernel_name(*one) for one in KERNELS), DROPS):
        for name, rows in sets.items():
            one = every_word(rows, Reading(kernel, drop), str(name))
            if one:
                shares = {key: round(one[key], 4) for key in ("ari_x_means", "ari_k_means")}
                found.append({"every word": kernel, "drop": drop, "data_set": str(name), **one, **shares})
    return found
