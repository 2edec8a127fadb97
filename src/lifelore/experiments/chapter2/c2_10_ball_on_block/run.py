"""C2.10: a ball A on a block B on the ground G reads {on(A, B), on(B, G)}, and B's network has two points.

Here the ground counts as an object, as it does in the figure. Contacts of pairs that perception says are not
related (the ball and the ground below it) are not counted; how many the ball would have with them stands beside.
Both cameras are measured, and in the real scenes every thing that lies on one thing on the table, whatever its
shape. Thesis: §2.3.6, Figure 2.2.
"""

from collections.abc import Mapping, Sequence

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter2.c2_10_ball_on_block.ball_on_block import CAMERAS, ball_cells, run_cell
from lifelore.experiments.chapter2.scene_example import draw_examples
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import exact_share, mean_or_unmeasured
from lifelore.experiments.engine.predicate import Predicate

FULL = {"scenes": 150, "real": True}
QUICK = {"scenes": 2, "real": False}


def _check(settings: Mapping) -> None:
    if settings["scenes"] < 1:
        raise InputError(f"scenes must be at least 1, got {settings['scenes']}")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares by camera: predicates right, B's network of two points, both networks as drawn."""
    found = {}
    for camera in (*CAMERAS, "real"):
        rows = [row for result in results if result["camera"] == camera for row in result["scenes"]]
        found[f"predicates_right_{camera}"] = exact_share(row["right"] for row in rows)
        found[f"two_points_of_the_lower_{camera}"] = exact_share(row["points"] == [1, 1] for row in rows)
        found[f"one_point_of_the_upper_{camera}"] = exact_share(row["upper_points"] == 1 for row in rows)
        found[f"one_point_of_the_upper_of_all_near_pairs_{camera}"] = exact_share(
            row["near_points"] == 1 for row in rows
        )
        found[f"mm_between_the_two_points_{camera}"] = mean_or_unmeasured(
            row["apart"] for row in rows if row["apart"]
        )
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How often each set of predicates and points came, by camera; and a picture of each camera."""
    counts: dict[tuple, int] = {}
    for result in results:
        for row in result["scenes"]:
            key = (result["camera"], row["said"], tuple(row["points"]))
            counts[key] = counts.get(key, 0) + 1
    counted = [
        {"camera": camera, "said": said, "points of B towards A and G": list(points), "scenes": n}
        for (camera, said, points), n in sorted(counts.items())
    ]
    return counted + [example for result in results for example in result["examples"]]


def _draw(result: Mapping):
    return draw_examples(result, columns=2)


CLAIM = Claim(
    id="C2.10",
    title="A ball on a block on the ground (Figure 2.2)",
    thesis="A ball A on a block B on the ground G is described as {on(A, B), on(B, G)}, and B by a network of two "
    "nodes.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C2.10"),
    cells=ball_cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes={
        "real predicates": "real things lie on one another in more ways than a ball on a block",
        "real network": "a contact of real things is hidden in its middle and comes out as two points",
    },
    check=_check,
)
