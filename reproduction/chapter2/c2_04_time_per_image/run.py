"""Cells of claim C2.4: seconds of one picture of two objects on one core, from labelled points to relations.

Pictures are drawn as the pairs of claims C2.1 to C2.3, but with their table. Everything compiled runs once before
the timing starts. Pictures are timed one after another, whatever the number of threads, and libraries use one
thread. The seconds of a picture are the median of some repeats. Thesis: §2.4.1.
"""

import time
from collections.abc import Mapping
from threading import Lock

import numpy as np
from threadpoolctl import threadpool_limits

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene
from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model
from lifelore.perception.segmentation.object_segmentation import SegmentationSettings, segmented
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.chapter2.scenes.tabletop_pairs import MIX
from reproduction.chapter2.scoring.perception_stages import STAGES, timed_stages
from reproduction.engine.provenance import processor

CAMERAS = ("stereo", "kinect")
DENSE = "stereo, made dense"
"""Some stereo pictures with their objects' points repeated: the thesis's cameras had 26 times our pixels."""
KINDS = (*CAMERAS, DENSE)
JITTER = 0.0005
"""Metres by which repeated points are moved."""
LOT = 11
_alone = Lock()


def cells(settings: Mapping) -> list[dict]:
    """Lots of pictures, camera by camera."""
    return [lot for camera in CAMERAS for lot in lots(settings["images"], LOT, camera=camera)]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """``{"processor", "images": […]}``, an image for each kind of a picture; see `timed_image`."""
    camera = cell["camera"]
    drawn = TabletopSettings(arrangement="pair", mix=MIX, camera=camera, shapes="all")
    images = []
    with _alone, threadpool_limits(1):
        model = shipped_model()
        for k in numbers_of(cell, LOT, settings["images"]):
            rng = stream(seed, "image timing", camera, k)
            cloud = sample_scene(int(rng.integers(2**31)), k, drawn).cloud
            if not images:
                timed_stages(cloud, model)  # compiled and warm
            image = timed_image(cloud, model, settings["repeats"])
            images.append({"kind": camera, **image, "segmentation": seconds_of_segmentation(cloud)})
            if camera == "stereo" and k % settings["dense_every"] == 0:
                dense = made_dense(cloud, settings["dense_points"], rng)
                images.append({"kind": DENSE, **timed_image(dense, model, settings["repeats"])})
    return {"processor": processor(), "images": images}


def timed_image(cloud: LabelledCloud, model: RelationClassifier, repeats: int) -> dict:
    """The seconds of a picture, from the repeat with the median time.

    ``points`` in all and ``points_of_things``, the objects; ``seconds`` of each of `STAGES`; and
    ``processor_seconds`` in all threads over the same.
    """
    rounds = []
    for _ in range(repeats):
        began = time.process_time()
        stages = timed_stages(cloud, model)
        rounds.append((sum(stages.values()), time.process_time() - began, stages))
    rounds.sort(key=lambda timed: timed[0])
    _, busy, stages = rounds[(len(rounds) - 1) // 2]
    return {
        "points": len(cloud.points),
        "points_of_things": int((cloud.labels > TABLE).sum()),
        "seconds": [round(stages[stage], 6) for stage in STAGES],
        "processor_seconds": round(busy, 6),
    }


def seconds_of_segmentation(cloud: LabelledCloud) -> float:
    """Seconds to segment the cloud without its labels; no other time includes them (§2.3.3)."""
    began = time.perf_counter()
    segmented(cloud.points, cloud.colours, SegmentationSettings(method="clusters"))
    return round(time.perf_counter() - began, 6)


def made_dense(cloud: LabelledCloud, n_points: int, rng: np.random.Generator) -> LabelledCloud:
    """The cloud with at least `n_points` points of objects: each repeated equally often and moved a little."""
    objects, rest = np.flatnonzero(cloud.labels > TABLE), np.flatnonzero(cloud.labels <= TABLE)
    times = max(1, -(-n_points // max(len(objects), 1)))
    rows = np.concatenate([rest, np.repeat(objects, times)])
    points = cloud.points[rows]
    points[len(rest) :] += rng.normal(0, JITTER, (len(rows) - len(rest), 3))
    colours = None if cloud.colours is None else cloud.colours[rows]
    return LabelledCloud(points, cloud.labels[rows], colours, cloud.camera)
