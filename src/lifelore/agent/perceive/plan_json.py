"""The plan of a perceived scene as JSON data.

``{"steps": [{"action", "objects": [{"id", "moved", …}], "look", "confidence"}], "confidence", "reason"}``. An
object has the places that the document gives it (`PLACES`), in the scene's frame and in the camera's: where it was
seen. ``moved`` says that an earlier step has moved it from there. ``look`` lists objects of the step whose top was
hidden until an earlier step: look whether anything rests on them, and plan again if so. ``reason`` says why there
is no plan, whose ``confidence`` then is null; it is null where there is one, also an empty one, whose goal holds
already. See `scene_plan` for the confidences.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from lifelore.perception.reasoning.scene_plan import ScenePlan

PLACES = ("centroid", "centroid_camera", "box", "box_camera", "top")
DIGITS = 4
"""Decimals of a probability."""


def plan_document(plan: ScenePlan, objects: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The plan as plain data; `objects` are those of the scene's document."""
    places = {one["id"]: {key: one[key] for key in PLACES if key in one} for one in objects}
    steps, moved = [], set()
    for step in plan.steps:
        named = [{"id": thing, "moved": thing in moved, **places[thing]} for thing in step.objects]
        sure = round(step.confidence, DIGITS)
        steps.append({"action": step.action, "objects": named, "look": list(step.look), "confidence": sure})
        moved.add(step.objects[0])
    confidence = round(plan.confidence, DIGITS) if plan.reason is None else None
    return {"steps": steps, "confidence": confidence, "reason": plan.reason}
