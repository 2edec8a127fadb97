"""Measures and rows of claim C2.7: contact points of the middle object, skeletons and predicates, by kind."""

from collections.abc import Mapping, Sequence

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter2.c2_07_oversegmented_stack.run import KINDS
from lifelore.experiments.engine.estimates import exact_share
from lifelore.experiments.engine.results_table import ResultsTable, tally

REAL = ("real stack", "real cut")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares by kind of two points in the middle, by three ways of counting, and of the stack's structure."""
    table = ResultsTable.nested(results, "scenes", keys=(), outer=("kind",))
    found = {}
    for kind in (*KINDS, *REAL):
        scenes, name = table.select(kind=kind).records, kind.replace(" ", "_").replace("-", "_")
        found[f"structure_{name}"] = exact_share(scene["path"] and scene["stacked"] for scene in scenes)
        if kind in ("stack", *REAL):
            found[f"two_points_{name}"] = exact_share(scene["nodes"][1] == 2 for scene in scenes)
            found[f"two_points_with_ground_{name}"] = exact_share(scene["grounded"] == 2 for scene in scenes)
            found[f"two_points_of_all_near_pairs_{name}"] = exact_share(scene["near"][1] == 2 for scene in scenes)
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How often each set of networks came, by kind; and a picture of each."""
    outcomes = (
        {"kind": r["kind"], "points": s["nodes"], "path": s["path"], "stacked": s["stacked"]}
        for r in results
        for s in r["scenes"]
    )
    return tally(outcomes, "scenes") + [example for result in results for example in result["examples"]]
