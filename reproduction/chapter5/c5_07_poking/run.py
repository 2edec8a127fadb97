"""C5.7: scenes cut by local convexity, then every segment poked in MuJoCo, and segmented again.

The camera takes a picture after each push; what moves together is merged, what moves apart is split. Both
segmentations are scored on the first cloud with true labels, which the method does not read. Thesis: §2.4.3, §2.5.

Three kinds of scene: *varied* (the tabletop's usual groups, piles, books and cartons), *flush* (blocks whose faces
join without a crease, beside or on one another) and *occluded* (a long block whose middle is hidden, so that two
parts of it are seen).
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.domains.tabletop.layout import Group, Placed, put_beside, stand, top
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.settings import TabletopScene, TabletopSettings
from lifelore.domains.tabletop.shapes import box
from lifelore.perception.segmentation.object_segmentation import TABLE_BAND, SegmentationSettings, cut_cloud
from reproduction.chapter2.scenes.arranged_scenes import Placement, arranged, settled, turned
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.chapter2.scoring.segmentation_scoring import FOUND, overlaps
from reproduction.chapter5.c5_07_poking.poke import PokedTabletop
from reproduction.chapter5.c5_07_poking.poked_segments import PokedSegments
from reproduction.engine.estimates import ratio_or_unmeasured

LOT = 2
KINDS = ("varied", "flush", "occluded")
CAMERA = "kinect"
ROUNDS = ((0.15, 0.4), (0.5, 0.75), (0.15, 0.75))
"""Shares of a segment's height between which a round pokes it: low, high, any."""
LENGTH = 0.025
"""Of a push, metres."""
TRIES = 4
"""Places that are tried until the fingertip has room."""
SETTINGS = SegmentationSettings()


def place_flush(rng: np.random.Generator) -> Group:
    """Two or three blocks with flush faces, side by side or stacked, and a block apart."""
    length, width, height = rng.uniform((0.07, 0.07, 0.07), (0.12, 0.12, 0.12))
    group: Group = [stand(box(length, width, height))]
    for _ in range(int(rng.integers(1, 3))):
        if rng.random() < 0.5:
            piece = stand(box(float(rng.uniform(0.06, 0.12)), width, height))
            group += put_beside(group, [piece], 0.0, 0.0006)
        else:
            below = group[0] if len(group) == 1 else group[int(rng.integers(len(group)))]
            if top([below]) < top(group):
                continue
            size = np.ptp(below.outline(), axis=0)
            x, y = below.outline()[:, :2].mean(axis=0)
            piece = stand(box(float(size[0]), float(size[1]), float(rng.uniform(0.05, 0.09))), None, top([below]))
            group.append(piece.moved(float(x), float(y)))
    group += put_beside(group, [_any_block(rng)], float(rng.uniform(0, 2 * np.pi)), float(rng.uniform(0.03, 0.08)))
    return turned(rng, group)


def _any_block(rng: np.random.Generator) -> Placed:
    size = rng.uniform((0.06, 0.05, 0.05), (0.12, 0.1, 0.12))
    return stand(box(float(size[0]), float(size[1]), float(size[2])), about(2, float(rng.uniform(0, np.pi))))


def place_occluded(rng: np.random.Generator) -> Group:
    """A long low block behind a tall narrow block, which hides its middle from the camera, and a block apart."""
    length, depth, height = map(float, rng.uniform((0.2, 0.05, 0.05), (0.28, 0.08, 0.09)))
    bar = stand(box(length, depth, height), about(2, rng.normal(0, 0.1)))
    size = rng.uniform((0.045, 0.06, 0.14), (0.06, 0.075, 0.2))
    screen = stand(box(float(size[0]), float(size[1]), float(size[2])), about(2, rng.normal(0, 0.1)))
    # The camera looks along +y.
    group = [bar, *put_beside([bar], [screen], -np.pi / 2, float(rng.uniform(0.035, 0.05)))]
    side = 0.0 if rng.random() < 0.5 else np.pi
    return [*group, *put_beside(group, [_any_block(rng)], side, float(rng.uniform(0.03, 0.08)))]


PLACEMENTS = {"flush": Placement(place_flush), "occluded": Placement(place_occluded)}


def cells(settings: Mapping) -> list[dict]:
    """Scenes in lots, by kind."""
    return [lot for kind in KINDS for lot in lots(settings["scenes"], LOT, kind=kind)]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """``{"kind", "scenes": […]}``: the outcomes of a lot's scenes."""
    scenes = []
    for number in numbers_of(cell, LOT, settings["scenes"]):
        scene = drawn_scene(cell["kind"], seed, number)
        random = stream(seed, "C5.7", "pokes", cell["kind"], number)
        scenes.append(outcome(scene.cloud.labels, *poke_scene(scene, random, settings["rounds"])))
    return {"kind": cell["kind"], "scenes": scenes}


def drawn_scene(kind: str, seed: int, number: int) -> TabletopScene:
    """Scene `number` of a kind, without cloths."""
    own_seed = int(stream(seed, "C5.7", "scenes", kind).integers(2**31))
    if kind in PLACEMENTS:
        return settled(PLACEMENTS[kind], f"C5.7 {kind}", own_seed, number)
    return arranged("varied", own_seed, number, TabletopSettings(shapes="all", camera=CAMERA))


def first_view(scene: TabletopScene) -> LabelledCloud:
    """The first cloud as local convexity cuts it; true labels are not read."""
    cloud = scene.cloud
    labels = cut_cloud(cloud.points, None, SETTINGS, cloud.camera).labels
    return LabelledCloud(cloud.points, labels, None, cloud.camera)


def poke_scene(
    scene: TabletopScene, rng: np.random.Generator, rounds: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Labels of the first cloud before and after every segment was poked once a round."""
    first = first_view(scene)
    table, known = PokedTabletop(scene.shapes, scene.poses), PokedSegments(first)
    for number in range(rounds):
        for segment in known.segments:
            for _ in range(TRIES):
                poke = known.poke_at(segment, rng, LENGTH, ROUNDS[number % len(ROUNDS)])
                if poke is None:
                    break
                if table.poke(poke.place, poke.push):
                    known.observe(poke, seen(table, scene, rng))
                    break
    return first.labels, known.corrected()


def seen(table: PokedTabletop, scene: TabletopScene, rng: np.random.Generator) -> LabelledCloud:
    """A picture in which only the table has a label, by height."""
    picture = table.picture(scene.view, CAMERA, rng)
    on_table = np.abs(picture.points[:, 2]) <= TABLE_BAND
    return LabelledCloud(picture.points, np.where(on_table, TABLE, 0), None, picture.camera)


def outcome(truth: NDArray[np.int64], before: NDArray[np.int64], after: NDArray[np.int64]) -> list[list[float]]:
    """``[points, IoU before, IoU after]`` of each object."""
    both = zip(overlaps(truth, before), overlaps(truth, after), strict=True)
    return [[old.points, round(old.iou, 4), round(new.iou, 4)] for old, new in both]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """All scenes together, and the objects found by kind; intervals resample scenes."""

    def of(kinds: Sequence[str]) -> dict[str, Estimate]:
        return measures_of([scene for result in results if result["kind"] in kinds for scene in result["scenes"]])

    own = {kind: of((kind,)) for kind in KINDS}
    shares = ("found_before", "found_after")
    return of(KINDS) | {f"{name}_{kind}": own[kind][name] for kind in KINDS for name in shares}


def measures_of(scenes: Sequence[Sequence]) -> dict[str, Estimate]:
    """Gain of overlap; objects found before and after, their gain, those corrected and lost."""
    objects = [np.array(scene, float).reshape(-1, 3) for scene in scenes]
    hit = [o[:, 1:] >= FOUND for o in objects]
    n = [len(h) for h in hit]
    return {
        "overlap_gain": ratio_or_unmeasured(
            [(o[:, 0] * (o[:, 2] - o[:, 1])).sum() for o in objects], [o[:, 0].sum() for o in objects]
        ),
        "found_before": ratio_or_unmeasured([h[:, 0].sum() for h in hit], n),
        "found_after": ratio_or_unmeasured([h[:, 1].sum() for h in hit], n),
        "found_gain": ratio_or_unmeasured([h[:, 1].sum() - float(h[:, 0].sum()) for h in hit], n),
        "corrected": ratio_or_unmeasured(
            [(~h[:, 0] & h[:, 1]).sum() for h in hit], [(~h[:, 0]).sum() for h in hit]
        ),
        "spoiled": ratio_or_unmeasured([(h[:, 0] & ~h[:, 1]).sum() for h in hit], [h[:, 0].sum() for h in hit]),
    }
