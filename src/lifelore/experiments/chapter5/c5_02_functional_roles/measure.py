"""Measures and rows of claim C5.2: objects in the same role, ranked by the likeness of their use."""

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter5.c5_02_functional_roles.ranking import average_precision, mean_by_cluster
from lifelore.experiments.chapter5.c5_02_functional_roles.run import ROLES
from lifelore.perception.topology.functional_similarity import overlap

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
    things = {pool: [t for r in results if r["pool"] == pool for t in r["things"]] for pool in ("first", "second")}
    queries = []
    for pool, others in (("first", things["second"]), ("second", things["first"])):
        for thing in things[pool]:
            relevant = [other["role"] == thing["role"] for other in others]
            scores = {name: _overlaps(thing[name], [other[name] for other in others]) for name in BAGS}
            scores["shape"] = _likeness(thing["shape"], [other["shape"] for other in others])
            scores["chance"] = np.zeros(len(others))
            precision = {name: average_precision(scores[name], relevant) for name in METHODS}
            queries.append({"scene": thing["scene"], "role": thing["role"], **precision})
    return queries


def _overlaps(bag: Mapping[str, int], others: Sequence[Mapping[str, int]]) -> np.ndarray:
    own = Counter(bag)
    return np.array([overlap(own, Counter(other)) for other in others])


def _likeness(histogram: Sequence[float], others: Sequence[Sequence[float]]) -> np.ndarray:
    """As `functional_similarity.shape_similarity`, from two histograms."""
    return 1 - np.abs(np.asarray(others) - np.asarray(histogram)).sum(axis=1) / 2


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """By role the mean average precision of each method; and pictures."""
    queries = judged_queries(results)
    table = []
    for role in ROLES:
        own = [query for query in queries if query["role"] == role]
        precision = {method: float(np.mean([query[method] for query in own])) for method in METHODS}
        table.append({"role": role, "queries": len(own), **precision})
    return table + [example for result in results for example in result["examples"]]
