"""Seconds of each stage of `perceive` on one labelled cloud."""

import time
from collections.abc import Callable
from typing import Any

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.perception.clouds.voxel import voxelised
from lifelore.perception.contacts.interface import interface
from lifelore.perception.contacts.near_pairs import near_pairs, split_objects
from lifelore.perception.pairs.scene_pairs import scene_pairs
from lifelore.perception.pairs.side_faces import pairs_beside
from lifelore.perception.reasoning.scene_logic import alternatives, most_likely_scene
from lifelore.perception.relations.relation_classifier import RelationClassifier
from lifelore.perception.scene import Scene
from lifelore.perception.scene_json import scene_document

STAGES = (
    "thin to voxels",
    "near pairs",
    "separators and contacts",
    "features",
    "relations",
    "logic",
    "networks and holes",
)


def timed_stages(
    cloud: LabelledCloud, model: RelationClassifier, clock: Callable[[], float] = time.perf_counter
) -> dict[str, float]:
    """Seconds by `clock` of each of `STAGES`; together they are what `perceive` does with a cloud it has read."""
    seconds: dict[str, float] = {}

    def timed(stage: str, work: Callable[[], Any]) -> Any:
        began = clock()
        result = work()
        seconds[stage] = clock() - began
        return result

    settings = model.settings
    thin = timed(STAGES[0], lambda: voxelised(cloud, settings.voxel))
    pairs = timed(STAGES[1], lambda: near_pairs(split_objects(thin), settings.near, settings.table_margin))
    found = timed(STAGES[2], lambda: tuple(interface(pair, settings) for pair in pairs))
    seen = timed(STAGES[3], lambda: scene_pairs(cloud, found, settings))
    beliefs = timed(STAGES[4], lambda: model.beliefs(seen))
    logic = timed(
        STAGES[5], lambda: most_likely_scene(alternatives(beliefs), cloud.objects, beside=pairs_beside(seen))
    )
    scene = Scene(cloud, found, logic.relations, logic.optimal, beliefs)
    timed(STAGES[6], lambda: scene_document(scene.without_unrelated_contacts, seconds=0.0))
    return seconds
