"""Measures and rows of claim C2.4."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter2.c2_04_time_per_image.run import CAMERAS, DENSE, KINDS
from lifelore.experiments.chapter2.perception_stages import STAGES
from lifelore.experiments.engine.estimates import quantile_estimate

NAMES = {kind: "stereo_dense" if kind == DENSE else kind for kind in KINDS}
"""How the names of measures end."""


def images_of(results: Sequence[Mapping], kind: str) -> list[Mapping]:
    """The pictures of one of `KINDS`."""
    return [image for result in results for image in result["images"] if image["kind"] == kind]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Wall seconds of a picture by camera: mean and 95 % point over pictures; and processor time beside."""
    found = {}
    for kind, name in NAMES.items():
        images = images_of(results, kind)
        wall = np.array([sum(image["seconds"]) for image in images])
        found |= {
            f"seconds_{name}": mean_estimate(wall),
            f"seconds_{name}_95_percent": quantile_estimate(wall, 0.95),
            f"seconds_{name}_slowest": Estimate(float(wall.max()), float(np.median(wall)), None, len(wall)),
            f"seconds_of_processor_a_second_{name}": ratio_estimate(
                [image["processor_seconds"] for image in images], wall
            ),
            f"points_{name}": mean_estimate([image["points"] for image in images]),
            f"points_of_things_{name}": mean_estimate([image["points_of_things"] for image in images]),
        }
    for camera in CAMERAS:
        apart = [image["segmentation"] for image in images_of(results, camera)]
        found[f"seconds_of_segmentation_{camera}"] = mean_estimate(apart)
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Medians by stage in milliseconds, every picture's seconds, and what it ran on."""
    found = []
    for kind in KINDS:
        seconds = np.array([image["seconds"] for image in images_of(results, kind)])
        whole = np.sort(seconds.sum(axis=1))
        for stage, times in zip(STAGES, seconds.T, strict=True):
            found.append({"images": kind, "stage": stage, "median_ms": round(1000 * float(np.median(times)), 3)})
        found.append({"images": kind, "seconds": np.round(whole, 4).tolist()})
    return [*found, {"processors": sorted({result["processor"] for result in results})}]
