"""C2.4: seconds of one picture of two objects on one core, from labelled points to networks and relations.

Pictures are drawn as the pairs of claims C2.1 to C2.3, but with their table. Everything compiled runs once before
the timing starts. Libraries use one thread. Seconds are those of the
processor, which a busy machine changes little; of a picture, the median of some repeats. Thesis: §2.4.1, without
segmentation (§2.3.3).
"""

import time
from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene
from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model
from lifelore.perception.scene_json import scene_document
from lifelore.perception.scene_perception import perceived_scene
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.chapter2.scenes.tabletop_pairs import MIX
from reproduction.engine.estimates import mean_or_unmeasured, quantile_estimate
from reproduction.engine.records import having, nested, values_of

KINDS = {"stereo": "stereo", "dense": "stereo, made dense"}
"""Pictures as our stereo camera gives them; and some with their objects' points repeated: the thesis's cameras had
26 times our pixels."""
JITTER = 0.0005
"""Metres by which repeated points are moved."""
LOT = 11


def cells(settings: Mapping) -> list[dict]:
    """Lots of pictures."""
    return lots(settings["images"], LOT)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """``{"images": […]}``, of each its ``kind``, ``points`` and ``seconds``."""
    drawn = TabletopSettings(arrangement="pair", mix=MIX, camera="stereo", shapes="all")
    images = []
    model = shipped_model()
    for k in numbers_of(cell, LOT, settings["images"]):
        rng = stream(seed, "image timing", "stereo", k)
        cloud = sample_scene(int(rng.integers(2**31)), k, drawn).cloud
        if not images:
            seconds_of(cloud, model)  # compiled and warm
        images.append({"kind": "stereo", **timed_image(cloud, model, settings["repeats"])})
        if k % settings["dense_every"] == 0:
            dense = made_dense(cloud, settings["dense_points"], rng)
            images.append({"kind": "dense", **timed_image(dense, model, settings["repeats"])})
    return {"images": images}


def timed_image(cloud: LabelledCloud, model: RelationClassifier, repeats: int) -> dict:
    """The points of a picture, and its seconds: the median of the repeats."""
    seconds = [seconds_of(cloud, model) for _ in range(repeats)]
    return {"points": len(cloud.points), "seconds": round(float(np.median(seconds)), 6)}


def seconds_of(cloud: LabelledCloud, model: RelationClassifier) -> float:
    """Processor seconds from labelled points to a document of relations, networks and holes."""
    began = time.process_time()
    scene_document(perceived_scene(cloud, model).without_unrelated_contacts, seconds=0.0)
    return time.process_time() - began


def made_dense(cloud: LabelledCloud, n_points: int, rng: np.random.Generator) -> LabelledCloud:
    """The cloud with at least `n_points` points of objects: each repeated equally often and moved a little."""
    objects, rest = np.flatnonzero(cloud.labels > TABLE), np.flatnonzero(cloud.labels <= TABLE)
    times = max(1, -(-n_points // max(len(objects), 1)))
    rows = np.concatenate([rest, np.repeat(objects, times)])
    points = cloud.points[rows]
    points[len(rest) :] += rng.normal(0, JITTER, (len(rows) - len(rest), 3))
    colours = None if cloud.colours is None else cloud.colours[rows]
    return LabelledCloud(points, cloud.labels[rows], colours, cloud.camera)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Seconds of a stereo picture, mean and 95 % point over pictures; the mean of dense ones; points of either."""
    images = nested(results, "images")
    found = {}
    for kind in KINDS:
        for key in ("seconds", "points"):
            found[f"{key}_{kind}"] = mean_or_unmeasured(image[key] for image in having(images, kind=kind))
    return found | {
        "seconds_stereo_95_percent": quantile_estimate(values_of(images, "seconds", kind="stereo"), 0.95)
    }
