"""The height of what an object rests on."""

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import BOTH, ON
from lifelore.perception.scene import Scene


def support_height(scene: Scene, label: int, min_confidence: float = 0.0) -> float | None:
    """Height in metres of the surface that carries an object; None where no stated relation says what does.

    0 for the table. For another object its visible top, but no higher than the lowest visible point of the
    object that it carries, which may stand in it; of several the lowest.

    Parameters
    ----------
    scene : Scene
    label : int
    min_confidence : float
        Least confidence of a relation, in [0, 1].
    """
    lowest = float(scene.cloud.of(label)[:, 2].min())
    heights = [
        0.0 if one.b == TABLE else min(float(scene.cloud.of(one.b)[:, 2].max()), lowest)
        for one in scene.relations
        if one.a == label and one.relation in (ON, BOTH) and one.confidence >= min_confidence
    ]
    return min(heights, default=None)
