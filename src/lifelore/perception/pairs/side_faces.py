"""Pairs whose side faces are beside each other: their visible parts share a range of heights."""

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.pairs.scene_pairs import ScenePairs

OVERLAP = 0.015
"""Metres of height that both objects' visible parts share at least; less is a tilted or overhanging object."""


def pairs_beside(scene: ScenePairs) -> set[frozenset[int]]:
    """Near pairs of objects that share at least `OVERLAP` of height."""
    feet, tops = scene.features.columns(("foot_a", "foot_b")), scene.features.columns(("top_a", "top_b"))
    shared = (tops.min(axis=1) - feet.max(axis=1))[::2]
    pairs = scene.features.pairs[::2]
    return {
        frozenset((int(a), int(b)))
        for (a, b), overlap in zip(pairs, shared, strict=True)
        if overlap >= OVERLAP and TABLE not in (a, b)
    }
