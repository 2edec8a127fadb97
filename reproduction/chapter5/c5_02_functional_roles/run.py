"""C5.2: objects in known roles, ranked by the likeness of their use.

Every object is a query; the objects of the other pool of shapes are ranked, and those in the same role should come
first. Scores are average precisions; intervals resample scenes. Thesis: §5.2.
"""

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.metrics import Estimate
from lifelore.core.relations import ADJACENT, NONE
from lifelore.core.streams import stream
from lifelore.perception.scene import Scene
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.chapter2.scenes.skeletons import perceived, reading
from reproduction.chapter5.c5_02_functional_roles.functional_similarity import overlap, role, shape_distribution
from reproduction.chapter5.role_scenes import PARTS, POOLS, role_scene
from reproduction.engine.estimates import mean_by_cluster


def average_precision(scores: ArrayLike, relevant: ArrayLike) -> float:
    """Expected average precision where items of equal score are ordered by chance (McSherry and Najork 2008).

    Items with higher `scores` ``(n,)`` come first; at least one of `relevant` ``(n,)`` must be true. The result is
    the mean over the relevant items of the precision at their place, in (0, 1].
    """
    scores, hit = np.asarray(scores, float), np.asarray(relevant, bool)
    total, before, found = 0.0, 0, 0
    for score in np.unique(scores)[::-1]:
        tied = scores == score
        n, right = int(tied.sum()), int(hit[tied].sum())
        if right:
            # At a place of the group: the one there, those found before, and its share of those tied before it.
            place = np.arange(n)
            share = (right - 1) / (n - 1) if n > 1 else 0.0
            total += right / n * float(((found + 1 + place * share) / (before + 1 + place)).sum())
        before, found = before + n, found + right
    return total / int(hit.sum())


LOT = 10
BAGS = ("topology", "predicates")
METHODS = (*BAGS, "shape", "chance")


def cells(settings: Mapping) -> list[dict]:
    """Scenes in lots, by pool of shapes and kind of scene."""
    return [lot for pool in POOLS for part in PARTS for lot in lots(settings["scenes"], LOT, pool=pool, part=part)]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The objects of a lot of scenes, each with its role and all descriptors."""
    name = f"{cell['pool']} {cell['part']}"
    objects = []
    for number in numbers_of(cell, LOT, settings["scenes"]):
        scene = perceived(role_scene(cell["part"], cell["pool"], name, seed, number).cloud)
        rng = stream(seed, "pairs of points", name, number)
        for label, own_role in enumerate(PARTS[cell["part"]].roles, start=2):
            objects.append({"scene": f"{name} {number}", "role": own_role, **descriptors(scene, label, rng)})
    return {"pool": cell["pool"], "things": objects}


def descriptors(scene: Scene, label: int, rng: np.random.Generator) -> dict:
    """The use of an object: its network among related pairs (`topology`) and its relations alone (`predicates`),
    each a bag of tokens; and its `shape`, a histogram.
    """
    bags = {"topology": role(reading(scene, ground=True), label), "predicates": predicate_bag(scene, label)}
    found = {
        name: {" ".join(map(str, token)): n for token, n in sorted(bag.items(), key=str)}
        for name, bag in bags.items()
    }
    return found | {"shape": [round(float(x), 5) for x in shape_distribution(scene.cloud.of(label), rng)]}


def predicate_bag(scene: Scene, label: int) -> Counter:
    """How often each predicate holds of an object, as first or second, with the table or another object."""
    bag: Counter = Counter()
    for found in scene.relations:
        if label in (found.a, found.b) and found.relation != NONE:
            other = found.b if found.a == label else found.a
            place = "either" if found.relation == ADJACENT else "first" if found.a == label else "second"
            bag[found.relation, place, "table" if other == TABLE else "thing"] += 1
    return bag


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Mean average precision by method, and differences to the other methods on the same queries."""
    queries = judged_queries(results)
    scenes = [query["scene"] for query in queries]
    found = {f"map_{name}": mean_by_cluster([q[name] for q in queries], scenes) for name in METHODS}
    for name in ("shape", "chance"):
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
            # 1 less half the L1 distance of two histograms.
            scores["shape"] = 1 - np.abs(shapes - np.array(item["shape"])).sum(axis=1) / 2
            scores["chance"] = np.zeros(len(others))
            precision = {name: average_precision(scores[name], relevant) for name in METHODS}
            queries.append({"scene": item["scene"], "role": item["role"], **precision})
    return queries
