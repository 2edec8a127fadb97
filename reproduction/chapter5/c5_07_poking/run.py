"""C5.7: scenes cut by local convexity, then every segment poked in MuJoCo, and segmented again.

The camera takes a picture after each push; what moves together is merged, what moves apart is split. Both
segmentations are scored on the first cloud with true labels, which the method does not read. Thesis: §2.4.3, §2.5.

Three kinds of scene: *varied* (the tabletop's usual groups, piles, books and cartons), *flush* (blocks whose faces
join without a crease, beside or on one another) and *occluded* (a long block whose middle is hidden, so that two
parts of it are seen).
"""

import base64
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.metrics import Estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.domains.tabletop.layout import Group, Placed, put_beside, stand, top
from lifelore.domains.tabletop.poke import PokedTabletop
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.settings import TabletopScene, TabletopSettings
from lifelore.domains.tabletop.shapes import box
from lifelore.perception.segmentation.object_segmentation import SegmentationSettings, segmented
from lifelore.perception.segmentation.poking import PokedLabels, PokedSegments
from reproduction.chapter2.scenes.arranged_scenes import Placement, arranged, settled, turned
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.chapter2.scoring.segmentation_scoring import FOUND, overlaps
from reproduction.engine.estimates import UNMEASURED

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
DRAWN, DRAWN_POINTS = 10, 4000
"""Scenes of a kind among which the example is looked for, and its largest number of points."""
AROUND, GRID = 0.04, 0.0005
"""Metres of table around an example's objects, and to which its points are rounded."""


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
    """Outcomes of a lot's scenes; pictures of the first scene of a kind."""
    scenes, examples = [], []
    for number in numbers_of(cell, LOT, settings["scenes"]):
        scene = drawn_scene(cell["kind"], seed, number)
        trial = poke_scene(scene, stream(seed, "C5.7", "pokes", cell["kind"], number), settings["rounds"])
        scenes.append({"kind": cell["kind"], "objects": outcome(scene.cloud.labels, trial)})
        if number == 0 or (number < DRAWN and (trial.after.merged or trial.after.split)):
            examples.append(example(cell["kind"], scene, trial))
    return {"scenes": scenes, "examples": examples}


def drawn_scene(kind: str, seed: int, number: int) -> TabletopScene:
    """Scene `number` of a kind, without cloths."""
    own_seed = int(stream(seed, "C5.7", "scenes", kind).integers(2**31))
    if kind in PLACEMENTS:
        return settled(PLACEMENTS[kind], f"C5.7 {kind}", own_seed, number)
    return arranged("varied", own_seed, number, TabletopSettings(shapes="all", camera=CAMERA))


@dataclass(frozen=True, eq=False)
class Trial:
    """A poked scene: labels of its first cloud before and after the pokes, and the number of pokes."""

    before: NDArray[np.int64]
    after: PokedLabels
    pokes: int


def first_view(scene: TabletopScene) -> LabelledCloud:
    """The first cloud as local convexity cuts it; true labels are not read."""
    cloud = scene.cloud
    labels = segmented(cloud.points, None, SETTINGS, cloud.camera)
    return LabelledCloud(cloud.points, labels, None, cloud.camera)


def poke_scene(scene: TabletopScene, rng: np.random.Generator, rounds: int) -> Trial:
    """Poke every segment once a round, and photograph the scene after each poke."""
    first = first_view(scene)
    table, known, pokes = PokedTabletop(scene.shapes, scene.poses), PokedSegments(first), 0
    for number in range(rounds):
        for segment in known.segments:
            for _ in range(TRIES):
                poke = known.poke_at(segment, rng, LENGTH, ROUNDS[number % len(ROUNDS)])
                if poke is None:
                    break
                if table.poke(poke.place, poke.push):
                    known.observe(poke, seen(table, scene, rng))
                    pokes += 1
                    break
    return Trial(first.labels, known.corrected(), pokes)


def seen(table: PokedTabletop, scene: TabletopScene, rng: np.random.Generator) -> LabelledCloud:
    """A picture in which only the table has a label, by height."""
    picture = table.picture(scene.view, CAMERA, rng)
    on_table = np.abs(picture.points[:, 2]) <= SETTINGS.table_band
    return LabelledCloud(picture.points, np.where(on_table, TABLE, 0), None, picture.camera)


def outcome(truth: NDArray[np.int64], trial: Trial) -> list[list[float]]:
    """``[points, IoU before, IoU after]`` of each object."""
    before, after = overlaps(truth, trial.before), overlaps(truth, trial.after.labels)
    return [[b.points, round(b.iou, 4), round(a.iou, 4)] for b, a in zip(before, after, strict=True)]


def example(kind: str, scene: TabletopScene, trial: Trial) -> dict:
    """A picture's data: the camera, and thinned points in half millimetres with true, first and last labels."""
    cloud, objects = scene.cloud, scene.cloud.points[scene.cloud.labels > TABLE]
    low, high = objects.min(axis=0)[:2] - AROUND, objects.max(axis=0)[:2] + AROUND
    rows = np.flatnonzero(((cloud.points[:, :2] >= low) & (cloud.points[:, :2] <= high)).all(axis=1))
    rows = rows[:: -(-len(rows) // DRAWN_POINTS)]
    labels = [found[rows] for found in (cloud.labels, trial.before, trial.after.labels)]
    table = np.vstack([np.round(cloud.points[rows] / GRID).T, *labels]).astype(np.int16)
    packed = base64.b64encode(zlib.compress(np.ascontiguousarray(table).tobytes(), 9)).decode()
    assert cloud.camera is not None
    changed = bool(trial.after.merged or trial.after.split)
    return {
        "example": kind, "changed": changed, "camera": [round(float(x), 4) for x in cloud.camera], "points": packed
    }  # fmt: skip


def unpacked(example: Mapping) -> tuple[NDArray[np.int64], list[LabelledCloud]]:
    """True labels ``(n,)`` of an `example`, and its cloud with true, first and last labels."""
    table = np.frombuffer(zlib.decompress(base64.b64decode(example["points"])), np.int16).reshape(6, -1)
    points, camera = np.asarray(table[:3].T * GRID, np.float64), np.array(example["camera"], float)
    labels = table[3:].astype(np.int64)
    return labels[0], [LabelledCloud(points, found, None, camera) for found in labels]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """All scenes together, and the objects found by kind; intervals resample scenes."""
    scenes = [scene for result in results for scene in result["scenes"]]
    found = measures_of(scenes)
    for kind in KINDS:
        own = measures_of([scene for scene in scenes if scene["kind"] == kind])
        found |= {f"{name}_{kind}": own[name] for name in ("found_before", "found_after")}
    return found


def measures_of(scenes: Sequence[Mapping]) -> dict[str, Estimate]:
    """Gain of overlap; objects found before and after, their gain, those corrected and lost."""
    objects = [np.array(scene["objects"], float).reshape(-1, 3) for scene in scenes]
    hit = [o[:, 1:] >= FOUND for o in objects]
    n = [len(h) for h in hit]
    return {
        "overlap_gain": _share(
            [(o[:, 0] * (o[:, 2] - o[:, 1])).sum() for o in objects], [o[:, 0].sum() for o in objects]
        ),
        "found_before": _share([h[:, 0].sum() for h in hit], n),
        "found_after": _share([h[:, 1].sum() for h in hit], n),
        "found_gain": _share([h[:, 1].sum() - float(h[:, 0].sum()) for h in hit], n),
        "corrected": _share([(~h[:, 0] & h[:, 1]).sum() for h in hit], [(~h[:, 0]).sum() for h in hit]),
        "spoiled": _share([(h[:, 0] & ~h[:, 1]).sum() for h in hit], [h[:, 0].sum() for h in hit]),
    }


def _share(parts: Sequence, wholes: Sequence) -> Estimate:
    """Ratio of sums over scenes; `UNMEASURED` where there is nothing to divide by."""
    whole = np.asarray(wholes, float)
    return ratio_estimate(np.asarray(parts, float)[whole > 0], whole[whole > 0]) if whole.sum() > 0 else UNMEASURED


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """For each kind the data of a picture: the first scene that pushes changed, or the first."""
    pictures = [example for result in results for example in result["examples"]]
    own = ([p for p in pictures if p["example"] == kind] for kind in KINDS)
    return [max(found, key=lambda p: p["changed"]) for found in own if found]
