"""Warnings of supports that no camera saw: an object far from what it is stated to rest on."""

from math import inf

from lifelore.core.relations import BOTH, ON
from lifelore.perception.scene import Scene, object_name
from lifelore.perception.segmentation.scene_warnings import SceneWarning

FAR_SUPPORT = 0.15
"""Metres between visible points. What hides a support is rarely higher; a table that is a wall gives such gaps."""


def support_warnings(scene: Scene) -> tuple[SceneWarning, ...]:
    """A warning, ``far_support``, where objects rest on what lies more than `FAR_SUPPORT` away; else none."""
    far = [
        f"{r.a} on {object_name(r.b)} ({100 * r.gap:.0f} cm)"
        for r in scene.relations
        if r.relation in (ON, BOTH) and FAR_SUPPORT < r.gap < inf
    ]
    if not far:
        return ()
    text = (
        f"supports that were not seen, with a gap: {', '.join(far)}; check the table (--up X,Y,Z), or look from"
        " another side"
    )
    return (SceneWarning("far_support", text),)
