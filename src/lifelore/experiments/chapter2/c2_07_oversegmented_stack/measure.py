"""Measures and rows of claim C2.7."""

from collections.abc import Mapping, Sequence

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter2.stack_skeletons import KINDS
from lifelore.experiments.engine.estimates import exact_share, mean_or_unmeasured

REAL = ("real stack", "real cut")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares by kind; `structure` is the skeleton with its predicates, `skeleton` the topology alone."""
    found = {}
    for kind in (*KINDS, *REAL):
        rows = [row for result in results if result["kind"] == kind for row in result["scenes"]]
        name = kind.replace(" ", "_").replace("-", "_")
        found[f"two_points_{name}"] = exact_share(row["nodes"][1] == 2 for row in rows)
        found[f"skeleton_{name}"] = exact_share(row["path"] for row in rows)
        found[f"structure_{name}"] = exact_share(row["path"] and row["stacked"] for row in rows)
        if kind in ("stack", *REAL):
            found[f"two_points_with_ground_{name}"] = exact_share(row["grounded"] == 2 for row in rows)
            found[f"two_points_of_all_near_pairs_{name}"] = exact_share(row["near"][1] == 2 for row in rows)
            apart = [row["apart"] for row in rows if row["apart"]]
            found[f"mm_between_the_two_points_{name}"] = mean_or_unmeasured(apart)
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How often each set of networks came, by kind; and a picture of each."""
    outcomes: dict[tuple, int] = {}
    for result in results:
        for row in result["scenes"]:
            key = (result["kind"], tuple(row["nodes"]), row["path"], row["stacked"])
            outcomes[key] = outcomes.get(key, 0) + 1
    counted = [
        {"kind": kind, "points": list(nodes), "path": path, "stacked": stacked, "scenes": n}
        for (kind, nodes, path, stacked), n in sorted(outcomes.items())
    ]
    return counted + [example for result in results for example in result["examples"]]
