"""Measures and rows of claim C2.10."""

from collections.abc import Mapping, Sequence

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter2.c2_10_ball_on_block.run import CAMERAS
from lifelore.experiments.engine.estimates import exact_share, mean_or_unmeasured


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
