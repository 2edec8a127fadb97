"""Measures, rows and pictures of claim C2.10: predicates and contact points of ball, block and ground."""

from collections.abc import Mapping, Sequence
from functools import partial

from lifelore.core.metrics import Estimate
from reproduction.chapter2.c2_10_ball_on_block.run import CAMERAS
from reproduction.chapter2.scenes.scene_example import draw_examples
from reproduction.chapter2.scenes.scene_lots import tally_and_examples
from reproduction.engine.estimates import exact_share
from reproduction.engine.results_table import ResultsTable

draw = partial(draw_examples, columns=2)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares by camera: predicates right, B's network of two points, A's of a single point."""
    table = ResultsTable.nested(results, "scenes", keys=(), outer=("camera",))
    found = {}
    for camera in (*CAMERAS, "real"):
        scenes = table.select(camera=camera).records
        found[f"predicates_right_{camera}"] = exact_share(scene["right"] for scene in scenes)
        found[f"two_points_of_the_lower_{camera}"] = exact_share(scene["points"] == [1, 1] for scene in scenes)
        found[f"one_point_of_the_upper_{camera}"] = exact_share(scene["upper_points"] == 1 for scene in scenes)
        near = exact_share(scene["near_points"] == 1 for scene in scenes)
        found[f"one_point_of_the_upper_of_all_near_pairs_{camera}"] = near
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How often each set of predicates and points came, by camera; and a picture of each camera."""

    def outcome(result: Mapping, scene: Mapping) -> dict:
        found = {"said": scene["said"], "points of B towards A and G": scene["points"]}
        return {"camera": result["camera"], **found}

    return tally_and_examples(results, "scenes", outcome)
