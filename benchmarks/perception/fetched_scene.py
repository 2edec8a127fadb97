"""Plans that fetch the objects of a scene, from perceived facts, judged by the truth: with and without labels.

Without labels, the objects of the plans are segments. A segment stands for the true object that it finds (IoU
of at least 0.5). A target that no segment finds has no plan. A plan that picks up a segment which stands for no
object is not valid.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from benchmarks.perception.fetch_plan import fetch_order, first_fault
from benchmarks.perception.segmentation_scenes import TrueScene, true_labels, unlabelled
from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.reasoning.hidden_tops import hidden_tops
from lifelore.perception.reasoning.label_distribution import label_distributions
from lifelore.perception.reasoning.planning_state import PLAN_CONFIDENCE, PlanningState, planning_state
from lifelore.perception.reasoning.scene_logic import alternatives
from lifelore.perception.relations.relation_classifier import shipped_model
from lifelore.perception.scene import Scene
from lifelore.perception.segmentation.table_frame import segmented_scene
from reproduction.chapter2.scoring.segmentation_scoring import matched_objects, overlaps

THRESHOLDS = (0.0, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 0.98)
UNKNOWN, AS_CLEAR = "hidden tops unknown", "hidden tops taken as clear"
NOT_FOUND, NO_PLAN, NO_OBJECT = "not found", "no plan: something may lie on it", "picks up no object"
Key = tuple[str, float]
"""How hidden tops count, and the threshold."""


@dataclass(frozen=True)
class Fetched:
    """Counts of a scene: objects to fetch, and by `Key` the plans and the valid ones among them.

    `failures` gives, for each target without a valid plan at the default threshold with hidden tops unknown, the
    reason.
    """

    targets: int
    plans: Mapping[Key, tuple[int, int]]
    failures: Mapping[int, str]


def fetched_given(cloud: LabelledCloud, truth: Iterable[PairLabel]) -> tuple[tuple[int, ...], Fetched]:
    """The objects of a labelled scene that are near another, and the plans that fetch them."""
    scene = perceived_scene(cloud, shipped_model())
    targets = tuple(sorted({end for i in scene.interfaces if TABLE not in (i.a, i.b) for end in (i.a, i.b)}))
    return targets, _fetched(scene, targets, {thing: thing for thing in scene.objects}, tuple(truth))


def fetched_without_labels(scene: TrueScene, targets: Sequence[int]) -> tuple[LabelledCloud | None, Fetched]:
    """The scene as it is cut without its labels, and the plans that fetch `targets`; None if it cannot be cut."""
    try:
        cut = segmented_scene(unlabelled(scene), scene.up).cloud
    except InputError:
        nothing = {(hidden, least): (0, 0) for hidden in (UNKNOWN, AS_CLEAR) for least in THRESHOLDS}
        return None, Fetched(len(targets), nothing, dict.fromkeys(targets, NOT_FOUND))
    stands_for = matched_objects(overlaps(true_labels(scene), cut.labels))
    return cut, _fetched(perceived_scene(cut, shipped_model()), targets, stands_for, scene.truth)


def _fetched(
    scene: Scene, targets: Sequence[int], stands_for: Mapping[int, int], truth: Sequence[PairLabel]
) -> Fetched:
    """The plans for true objects; `stands_for` gives the true object of each perceived object that has one."""
    beliefs = label_distributions(alternatives(scene.beliefs))
    plans: dict[Key, tuple[int, int]] = {}
    failures: dict[int, str] = {}
    for way, tops in ((UNKNOWN, hidden_tops(scene.cloud)), (AS_CLEAR, ())):
        for least in THRESHOLDS:
            state = planning_state(scene.relations, scene.objects, least, beliefs, tops)
            faults = {target: _fault(state, target, stands_for, truth) for target in targets}
            planned = [fault for fault in faults.values() if fault not in (NOT_FOUND, NO_PLAN)]
            plans[way, least] = len(planned), planned.count(None)
            if (way, least) == (UNKNOWN, PLAN_CONFIDENCE):
                failures = {target: fault for target, fault in faults.items() if fault is not None}
    return Fetched(len(targets), plans, failures)


def _fault(
    state: PlanningState, target: int, stands_for: Mapping[int, int], truth: Sequence[PairLabel]
) -> str | None:
    """Why there is no valid plan for a true object; None where there is."""
    segment = next((segment for segment, thing in stands_for.items() if thing == target), None)
    if segment is None:
        return NOT_FOUND
    order = fetch_order(state, segment)
    if order is None:
        return NO_PLAN
    if not all(picked in stands_for for picked in order):
        return NO_OBJECT
    fault = first_fault([stands_for[picked] for picked in order], truth)
    return None if fault is None else f"{fault[1]} rests on {fault[0]}"
