"""C2.7: three things on one another, and two things wrongly segmented into three, have one structure.

The middle thing's network merges its contact with the thing below and that with the thing above: two points. A
thing cut level into two has, with the other thing, the same skeleton: one point, two points, one point. Contacts
with the ground are not counted (the thesis's background is taken off), nor those of near pairs that perception
says are not related; both other countings stand beside. Three neighbours in a row have that skeleton too, as have
two things on one: without its predicates a skeleton knows no up. So a control has the structure only if its
predicates agree. Thesis: §2.4.3, Figure 2.7.
"""

from collections.abc import Mapping, Sequence

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter2.scene_example import draw_examples
from lifelore.experiments.chapter2.stack_skeletons import KINDS, run_cell, stack_cells
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import exact_share, mean_or_unmeasured
from lifelore.experiments.engine.predicate import Predicate

CAPTIONS = {
    "stack": "three things",
    "cut": "two things, segmented into three",
    "row": "three in a row",
    "two-on-one": "two on one",
    "real stack": "three real things",
    "real cut": "two real things, segmented into three",
}
REAL = ("real stack", "real cut")
FULL = {"scenes": 150, "real": True}
QUICK = {"scenes": 2, "real": False}


def _check(settings: Mapping) -> None:
    if settings["scenes"] < 1:
        raise InputError(f"scenes must be at least 1, got {settings['scenes']}")


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


def _draw(result: Mapping):
    return draw_examples(result, columns=3, captions=CAPTIONS)


CLAIM = Claim(
    id="C2.7",
    title="A stack of three, and two things wrongly segmented into three (Figure 2.7)",
    thesis="In a stack of three the middle object's merged skeleton has two nodes; where two objects are wrongly "
    "segmented into three, the same structure is observed.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C2.7"),
    cells=stack_cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes={
        "real stacks": "real things meet in contacts of more than one part, and there are five",
        "real cuts": "real things are seen from one side and in part",
    },
    check=_check,
)
