"""The shipped model apart: arrangements of books, boxes and cartons, and its calibration."""

from collections.abc import Callable, Sequence

import numpy as np

from benchmarks.perception.relation_learners import CONTACTS, SHIPPED, SeenScene, asked
from benchmarks.perception.relation_scenes import HELD_OUT, true_gaps
from lifelore.domains.tabletop.piles import PILES
from lifelore.domains.tabletop.tabletop import TabletopSettings, tabletop_scenes
from lifelore.perception.pairs.scene_pairs import scene_pairs
from lifelore.perception.relations.relation_classifier import RelationClassifier
from reproduction.chapter2.scoring.relation_scoring import JudgedPair

ARRANGEMENTS = tuple(PILES)
ARRANGED_SCENES = 10
"""Scenes of each arrangement in a round."""
BINS = 10


def judged_arrangement(
    name: str, repeats: int, model: RelationClassifier, after: Callable[[str], None]
) -> dict[str, list[JudgedPair]]:
    """The model's answers on scenes of an arrangement, of shapes that it did not learn from."""
    seed, shapes = HELD_OUT
    scenes = []
    for scene in tabletop_scenes(
        ARRANGED_SCENES * repeats, seed, TabletopSettings(arrangement=name, shapes=shapes)
    ):
        seen = {CONTACTS: scene_pairs(scene.cloud)}
        scenes.append(SeenScene(scene.name, scene.truth, scene.cloud.objects, seen, true_gaps(scene)))
        after(f"{name} seen")
    return asked(SHIPPED, model, scenes)


def calibration_error(judged: Sequence[JudgedPair]) -> float | None:
    """Mean distance of confidence from accuracy over bins (the expected calibration error); None of no pairs.

    The bins of confidence have equal width and weigh as many as their pairs. Pairs without a prediction are left
    out.
    """
    answers = np.array([(p.predicted.confidence, p.exact) for p in judged if p.predicted is not None], float)
    if not len(answers):
        return None
    confidence, right = answers.T
    at = np.minimum((confidence * BINS).astype(int), BINS - 1)
    off = np.bincount(at, confidence - right, BINS)
    return float(np.abs(off).sum() / len(answers))
