"""Measures, rows and pictures of claim C2.7: contact points of the middle object, skeletons, predicates."""

from collections.abc import Mapping, Sequence
from functools import partial

from lifelore.core.metrics import Estimate
from reproduction.chapter2.c2_07_oversegmented_stack.run import KINDS, REAL
from reproduction.chapter2.scenes.scene_example import draw_examples
from reproduction.chapter2.scenes.scene_lots import tally_and_examples
from reproduction.engine.estimates import exact_share
from reproduction.engine.results_table import ResultsTable

CAPTIONS = {
    "stack": "three objects",
    "cut": "two objects, segmented into three",
    "row": "three in a row",
    "two-on-one": "two on one",
    "real stack": "three real objects",
    "real cut": "two real objects, segmented into three",
}
draw = partial(draw_examples, captions=CAPTIONS)


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

    def outcome(result: Mapping, scene: Mapping) -> dict:
        networks = {"points": scene["nodes"], "path": scene["path"], "stacked": scene["stacked"]}
        return {"kind": result["kind"], **networks}

    return tally_and_examples(results, "scenes", outcome)
