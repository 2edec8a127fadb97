"""C5.2: things that are used alike are found by the topology of their contact point networks.

Each thing of a scene is a query, and all things of the other pool of shapes, which has no kind of shape in
common, are ranked by how alike they are; those of the same role should come first. What a role is was settled by
how the scene was put and what physics made of it (`thing_roles`), not by perception. Beside the networks'
topology stand the predicates alone, a descriptor of shape (D2), and chance. Equal scores are ordered by chance,
and counted as expected. Scenes are resampled, and `n` counts scenes. Thesis: §5.2, "functional similarity between
different objects".
"""

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter2.scene_example import scene_of_row
from lifelore.experiments.chapter5.c5_02_functional_roles.ranking import average_precision, mean_by_cluster
from lifelore.experiments.chapter5.c5_02_functional_roles.thing_roles import ROLES, role_cells, run_cell
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.predicate import Predicate
from lifelore.perception.topology.functional_similarity import overlap

FULL = {"scenes": 20}
QUICK = {"scenes": 1}
BAGS = ("topology", "near", "predicates")
METHODS = {
    "topology": "topology of networks",
    "near": "the same of all near pairs",
    "predicates": "predicates alone",
    "shape": "shape (D2)",
    "chance": "chance",
}


def _check(settings: Mapping) -> None:
    if settings["scenes"] < 1:
        raise InputError(f"scenes must be at least 1, got {settings['scenes']}")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Mean average precision by method, differences to peers on the same queries, and by role."""
    queries = judged_queries(results)
    scenes = [query["scene"] for query in queries]
    found = {f"map_{name}": mean_by_cluster([q[name] for q in queries], scenes) for name in METHODS}
    for peer in ("shape", "chance", "predicates", "near"):
        found[f"topology_less_{peer}"] = mean_by_cluster([q["topology"] - q[peer] for q in queries], scenes)
    for role in ROLES:
        own = [query for query in queries if query["role"] == role]
        values, clusters = [q["topology"] for q in own], [q["scene"] for q in own]
        found[f"map_topology_{role.replace(' ', '_')}"] = mean_by_cluster(values, clusters)
    return found


def judged_queries(results: Sequence[Mapping]) -> list[dict]:
    """For each thing its scene, its role, and by method the average precision among the other pool's things."""
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
    """As `functional_similarity.shape_similarity`, from histograms known already."""
    return 1 - np.abs(np.asarray(others) - np.asarray(histogram)).sum(axis=1) / 2


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """By role the mean average precision of each method; and pictures."""
    queries = judged_queries(results)
    table = []
    for role in ROLES:
        own = [query for query in queries if query["role"] == role]
        table.append(
            {"role": role, "queries": len(own), **{m: float(np.mean([q[m] for q in own])) for m in METHODS}}
        )
    return table + [example for result in results for example in result["examples"]]


def _draw(result: Mapping):
    from lifelore.experiments.chapter5.c5_02_functional_roles.figure_role_precision import draw_role_precision

    table = [row for row in result["rows"] if "role" in row]
    examples = [scene_of_row(row) for row in result["rows"] if "example" in row]
    overall = {name: result["measured"][f"map_{name}"] for name in METHODS}
    return draw_role_precision(table, overall, METHODS, examples)


CLAIM = Claim(
    id="C5.2",
    title="Things used alike, found by the topology of their networks",
    thesis="Proposed, not tested: functional similarity between different objects, to classify objects by the "
    "way in which they are used in a scene.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C5.2"),
    cells=role_cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes={
        "found": "contacts that come out as two points, or carry through a thin thing, change a role's topology"
    },
    check=_check,
)
