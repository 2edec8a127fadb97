"""O6: objects found in clouds without labels, by local convexity and by simpler ways to cut.

An object is found if a segment overlaps it by an IoU of at least 0.5. Simulated scenes have shapes on which no
parameter was chosen; real scenes are those of the Object Segmentation Database at hand. Intervals resample scenes.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.segmentation.object_segmentation import SegmentationSettings
from lifelore.perception.segmentation.table_frame import Up, segmented_scene
from reproduction.chapter2.scenes.real_scenes import real_scenes_folder
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of, real_lots
from reproduction.chapter2.scoring.segmentation_scoring import FOUND, overlaps
from reproduction.engine.estimates import ratio_or_unmeasured

LOT = 5
SEED = 7021
"""Of the simulated scenes; the run's seed is added."""
METHODS = {name: SegmentationSettings(method=name) for name in ("convexity", "clusters", "colour")}
"""The default, gaps of more than 12 mm, and the thesis's colour clusters (§2.3.3)."""
CONVEXITY, CLUSTERS, COLOUR = METHODS
SIMULATED, REAL = "simulated", "real"


def cells(settings: Mapping) -> list[dict]:
    """Simulated and real scenes in lots."""
    return [*lots(settings["scenes"], LOT), *real_lots(settings, LOT, "names")]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """``{"scenes": where, "found": […]}``: by scene and method the objects ``[points, IoU]``."""
    if "names" in cell:
        folder = real_scenes_folder()
        assert folder is not None
        clouds = (read_cloud(folder / f"{name}.pcd") for name in cell["names"])
        return {"scenes": REAL, "found": [found_by_method(c.only(c.measured), "table") for c in clouds]}
    drawn = TabletopSettings(shapes="held-out")
    numbers = numbers_of(cell, LOT, settings["scenes"])
    clouds = (sample_scene(SEED + seed, number, drawn).cloud for number in numbers)
    whole = (PointCloud(c.points, c.labels, c.colours, camera=c.camera) for c in clouds)
    return {"scenes": SIMULATED, "found": [found_by_method(cloud, "z") for cloud in whole]}


def found_by_method(cloud: PointCloud, up: Up) -> dict[str, list[list[float]]]:
    """Each true object ``[points, IoU]`` by method; none of the methods reads the labels."""
    assert cloud.labels is not None
    bare = PointCloud(cloud.points, None, cloud.colours, camera=cloud.camera)
    return {
        method: [[o.points, round(o.iou, 4)] for o in overlaps(cloud.labels, labels_by(bare, up, method))]
        for method in METHODS
    }


def labels_by(cloud: PointCloud, up: Up, method: str) -> NDArray[np.int64]:
    """Labels (n,) that a method gives; no object where a scene shows too few colours to be cut by colour."""
    try:
        return segmented_scene(cloud, up, METHODS[method]).cloud.labels
    except InputError:
        if method != COLOUR:
            raise
        return np.zeros(len(cloud.points), np.int64)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Gains of the default in simulated scenes, and how well it does in real ones."""
    real = measures_of(results, REAL)
    return {
        **measures_of(results, SIMULATED),
        **{f"{name}_real": real[name] for name in ("weighted_overlap", "found_convexity")},
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The gains in simulated and in real scenes."""
    for where in (SIMULATED, REAL):
        found = measures_of(results, where)
        if found["found_convexity"].n:
            yield {"scenes": where}, {name: found[name] for name in ("more_than_clusters", "more_than_colour")}


def measures_of(results: Sequence[Mapping], where: str) -> dict[str, Estimate]:
    """Shares of objects found, gains of the default, and its weighted overlap, over the scenes of a kind."""
    scenes = [scene for result in results if result["scenes"] == where for scene in result["found"]]
    objects = {name: [np.array(scene[name], float).reshape(-1, 2) for scene in scenes] for name in METHODS}
    n = np.array([len(o) for o in objects[CONVEXITY]], float)
    hit = {name: np.array([(o[:, 1] >= FOUND).sum() for o in own], float) for name, own in objects.items()}
    points = np.array([o[:, 0].sum() for o in objects[CONVEXITY]])
    return {
        **{f"found_{name}": ratio_or_unmeasured(hit[name], n) for name in METHODS},
        "more_than_clusters": ratio_or_unmeasured(hit[CONVEXITY] - hit[CLUSTERS], n),
        "more_than_colour": ratio_or_unmeasured(hit[CONVEXITY] - hit[COLOUR], n),
        "weighted_overlap": ratio_or_unmeasured(
            np.array([o.prod(axis=1).sum() for o in objects[CONVEXITY]]), points
        ),
    }
