"""Measures and rows of claim C5.2: objects in the same role, ranked by the likeness of their use."""

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.metrics import Estimate
from lifelore.perception.topology.functional_similarity import overlap
from reproduction.chapter2.scenes.scene_lots import examples_in
from reproduction.chapter5.c5_02_functional_roles.ranking import average_precision, mean_by_cluster
from reproduction.chapter5.c5_02_functional_roles.run import ROLES

BAGS = ("topology", "near", "predicates")
METHODS = {
    "topology": "topology of networks",
    "near": "the same of all near pairs",
    "predicates": "predicates alone",
    "shape": "shape (D2)",
    "chance": "chance",
}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Mean average precision by method, and differences to the other methods on the same queries."""
    queries = judged_queries(results)
    scenes = [query["scene"] for query in queries]
    found = {f"map_{name}": mean_by_cluster([q[name] for q in queries], scenes) for name in METHODS}
    for name in ("shape", "chance", "predicates", "near"):
        found[f"topology_less_{name}"] = mean_by_cluster([q["topology"] - q[name] for q in queries], scenes)
    return found


def judged_queries(results: Sequence[Mapping]) -> list[dict]:
    """For each object its scene, its role, and by method the average precision among the other pool's objects."""
    first, second = (
        [item for result in results if result["pool"] == pool for item in result["things"]]
        for pool in ("first", "second")
    )
    queries = []
    for items, others in ((first, second), (second, first)):
        bags = {name: [Counter(other[name]) for other in others] for name in BAGS}
        shapes = np.array([other["shape"] for other in others])
        for item in items:
            relevant = [other["role"] == item["role"] for other in others]
            scores: dict[str, ArrayLike] = {
                name: [overlap(Counter(item[name]), bag) for bag in bags[name]] for name in BAGS
            }
            # As `functional_similarity.shape_similarity`, from two histograms.
            scores["shape"] = 1 - np.abs(shapes - np.array(item["shape"])).sum(axis=1) / 2
            scores["chance"] = np.zeros(len(others))
            precision = {name: average_precision(scores[name], relevant) for name in METHODS}
            queries.append({"scene": item["scene"], "role": item["role"], **precision})
    return queries


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """By role the mean average precision of each method; and pictures."""
    queries = judged_queries(results)
    table = []
    for role in ROLES:
        own = [query for query in queries if query["role"] == role]
        precision = {method: float(np.mean([query[method] for query in own])) for method in METHODS}
        table.append({"role": role, "queries": len(own), **precision})
    return table + examples_in(results)
