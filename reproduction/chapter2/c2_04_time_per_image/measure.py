"""Measures and rows of claim C2.4: seconds of a picture, by camera."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from reproduction.chapter2.c2_04_time_per_image.run import DENSE, KINDS
from reproduction.chapter2.scoring.perception_stages import STAGES
from reproduction.engine.estimates import quantile_estimate, share_of
from reproduction.engine.results_table import ResultsTable

NAMES = {kind: "stereo_dense" if kind == DENSE else kind for kind in KINDS}
"""Endings of the measures' names."""
WELL_UNDER = 0.5
"""Seconds, as in the conditions."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Wall seconds of a stereo picture, mean and 95 % point over pictures; points of a picture by kind.

    Also the mean of pictures made dense, and the share of kinds of pictures in well under a second.
    """
    table = images(results)
    wall = wall_seconds(table, "stereo")
    found = {"seconds_stereo": mean_estimate(wall), "seconds_stereo_95_percent": quantile_estimate(wall, 0.95)}
    means = {kind: mean_estimate(wall_seconds(table, kind)) for kind in KINDS}
    found["seconds_stereo_dense"] = means[DENSE]
    well_under = [mean.ci95 is not None and mean.ci95[1] <= WELL_UNDER for mean in means.values()]
    found["seconds_of_kinds_well_under_one"] = share_of(well_under)
    return found | {f"points_{name}": table.mean("points", kind=kind) for kind, name in NAMES.items()}


def images(results: Sequence[Mapping]) -> ResultsTable:
    """Every timed picture, by its kind."""
    return ResultsTable.nested(results, "images", keys=("kind",))


def wall_seconds(table: ResultsTable, kind: str) -> np.ndarray:
    """Seconds of each picture of a kind over all stages."""
    return np.array([sum(image["seconds"]) for image in table.select(kind=kind).records])


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Medians by stage in milliseconds; every picture's seconds, its points and its other times; the processor."""
    found, table = [], images(results)
    for kind in KINDS:
        seconds = table.values("seconds", kind=kind)
        for stage, times in zip(STAGES, seconds.T, strict=True):
            found.append({"images": kind, "stage": stage, "median_ms": round(1000 * float(np.median(times)), 3)})
        row = {"images": kind, "seconds": np.round(np.sort(seconds.sum(axis=1)), 4).tolist()}
        row["points_of_things"] = table.mean("points_of_things", kind=kind).to_dict()
        busy = ratio_estimate(table.values("processor_seconds", kind=kind), wall_seconds(table, kind))
        row["seconds_of_processor_a_second"] = busy.to_dict()
        if kind != DENSE:
            row["seconds_of_segmentation"] = table.mean("segmentation", kind=kind).to_dict()
        found.append(row)
    return [*found, {"processors": sorted({result["processor"] for result in results})}]
