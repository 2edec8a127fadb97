"""The scenes of `bench relations`: simulated and real ones as everybody sees them, and the same scenes spoilt."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.perception.relation_learners import CONTACTS, SeenScene, seen_scene
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopScene
from lifelore.perception.contacts.interface import interfaces
from lifelore.perception.pairs.scene_pairs import scene_pairs
from reproduction.chapter2.scenes.perturbation import (
    fewer_points,
    grown_masks,
    noisier_depth,
    swapped_border,
)
from reproduction.chapter2.scenes.real_scenes import real_scenes
from reproduction.chapter2.scoring.network_stability import Stability, contact_nodes, stability

LEARNT, HELD_OUT = (7001, "training"), (7002, "held-out")
"""Seed and shapes of the scenes to learn from and of those to be judged on: no shape in common."""
HALF, THIRD, TENTH = "50 % of points discarded", "70 % of points discarded", "90 % of points discarded"
NOISE, LABELS, MASKS = "2 mm more depth noise", "labels swapped at borders", "masks grown by 5 mm"
SPOILT: dict[str, Callable[[LabelledCloud, np.random.Generator], LabelledCloud]] = {
    HALF: lambda cloud, rng: fewer_points(cloud, 0.5, rng),
    THIRD: lambda cloud, rng: fewer_points(cloud, 0.7, rng),
    TENTH: lambda cloud, rng: fewer_points(cloud, 0.9, rng),
    NOISE: lambda cloud, rng: noisier_depth(cloud, 0.002, rng),
    LABELS: swapped_border,
    MASKS: grown_masks,
}
THINNED = (HALF, THIRD)
"""Spoilt ways in which the networks are compared."""


@dataclass(frozen=True, eq=False)
class SpoiltScene:
    """A scene, what our method sees of it once spoilt (by name of `SPOILT`), and how its networks fared."""

    scene: SeenScene
    spoilt: dict[str, SeenScene]
    networks: dict[str, Stability]


def seen_simulated(scene: TabletopScene) -> SeenScene:
    """A simulated scene as everybody sees it."""
    return seen_scene(scene.name, scene.cloud, scene.truth, true_gaps(scene))


def spoilt_simulated(scene: TabletopScene) -> SpoiltScene:
    """A simulated scene, and the same spoilt in every way."""
    return _spoilt(scene.name, scene.cloud, scene.truth, true_gaps(scene), tuple(SPOILT))


def spoilt_real() -> list[SpoiltScene]:
    """The real scenes, thinned for the comparison of networks."""
    return [_spoilt(scene.name, scene.cloud, scene.truth, None, THINNED) for scene in real_scenes()]


def true_gaps(scene: TabletopScene) -> dict[frozenset[int], float]:
    """Visible gaps without noise of ``{a, b}``, metres."""
    return {frozenset((gap.a, gap.b)): gap.visible for gap in scene.gaps}


def _spoilt(
    name: str,
    cloud: LabelledCloud,
    truth: tuple[PairLabel, ...],
    gaps: dict[frozenset[int], float] | None,
    ways: tuple[str, ...],
) -> SpoiltScene:
    found = interfaces(cloud)
    nodes = contact_nodes(found, truth)
    spoilt, networks = {}, {}
    for way in ways:
        worse = SPOILT[way](cloud, stream(0, "spoilt", name, way))
        found_then = interfaces(worse)
        seen = {CONTACTS: scene_pairs(worse, found_then)}
        # Gaps stay those of the whole scene: what is a border pair does not depend on what was done to it.
        spoilt[way] = SeenScene(name, truth, cloud.objects, seen, gaps)
        if way in THINNED:
            networks[way] = stability(nodes, contact_nodes(found_then, truth))
    return SpoiltScene(seen_scene(name, cloud, truth, gaps, scene_pairs(cloud, found)), spoilt, networks)
