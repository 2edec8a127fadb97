"""C2.4: one picture of two things in well under a second.

The whole way from labelled points to networks and relations (thinned to voxels, separators, contacts, features,
relations, logic, holes) on one core, with the model that comes with the package loaded and everything compiled.
Pictures come segmented, as §2.3.2 assumes; what segmentation takes stands beside. Thesis: §2.4.1, in MATLAB with
SVM-light on two cores of its time.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter2.c2_04_time_per_image.image_timing import (
    CAMERAS,
    DENSE,
    KINDS,
    run_cell,
    timing_cells,
)
from lifelore.experiments.chapter2.perception_stages import STAGES
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.estimates import quantile_estimate
from lifelore.experiments.engine.predicate import Predicate

FULL = {"images": 132, "repeats": 3, "dense_points": 1_000_000, "dense_every": 4}
QUICK = {"images": 3, "repeats": 1, "dense_points": 100_000, "dense_every": 1}
NAMES = {kind: "stereo_dense" if kind == DENSE else kind for kind in KINDS}
"""How the names of measures end."""


def _check(settings: Mapping) -> None:
    for key in settings:
        if settings[key] < 1:
            raise InputError(f"{key} must be at least 1, got {settings[key]}")


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


def _draw(result: Mapping):
    from lifelore.experiments.chapter2.c2_04_time_per_image.figure_stage_times import draw_stage_times

    whole = {row["images"]: row["seconds"] for row in result["rows"] if "seconds" in row}
    stages = {
        kind: {
            row["stage"]: row["median_ms"]
            for row in result["rows"]
            if row.get("images") == kind and "stage" in row
        }
        for kind in whole
    }
    return draw_stage_times(whole, stages, marks={"half a second": 0.5, "a second": 1.0})


CLAIM = Claim(
    id="C2.4",
    title="One picture of two things in well under a second",
    thesis="The implementation (MATLAB with SVM-light) processes an entire picture in well under a second on a "
    "dual-core desktop computer.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C2.4"),
    cells=timing_cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    check=_check,
    timed=True,
)
