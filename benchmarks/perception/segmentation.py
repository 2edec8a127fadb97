"""`bench segmentation`: objects found in clouds without labels, and the relations perceived between them.

Segmentation by convexity beside distance clusters, cuts at sharp curvature, the thesis's colour clusters (§2.3.3)
and given labels, on the real scenes and on simulated scenes with shapes of their own. `segmentation_scoring` and
`segmented_relations` define the measures. Four real scenes are drawn as most methods find them, under
``results/segmentation``.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from statistics import median

import numpy as np

from benchmarks.perception.segmentation_scenes import (
    CURVATURE,
    GIVEN,
    METHODS,
    FoundScene,
    TrueScene,
    found_scene,
    real_true_scenes,
    simulated_true_scenes,
    true_labels,
)
from benchmarks.rounds import at_least, at_most, estimated_row, row
from lifelore.core.metrics import ratio_estimate
from lifelore.core.protocols import Progress
from lifelore.perception.relations.relation_classifier import shipped_model
from reproduction.chapter2.scenes.real_scenes import VARIABLE
from reproduction.chapter2.scoring.segmentation_scoring import segmentation_score

REAL, SIMULATED = "real", "simulated"
SCENES = 10
"""Simulated scenes a round."""
DRAWN = ("learn18", "learn38", "test49", "test53")
"""Real scenes of the figure: an occluded box, a bowl, and the two with the most objects."""
OUT = Path("benchmarks/results/segmentation")
BANDS = (0.0, 0.5, 0.8, 0.95, 1.01)
"""Of confidence."""
NO_REAL_SCENES = (
    f"The goals are of real scenes, which need {VARIABLE}: "
    "set it to a folder with osd/relations.csv and its clouds."
)
"""The note of a run without the real scenes."""
Found = dict[str, list[FoundScene]]
"""The scenes as each method finds them."""


def bench_segmentation(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`. Each round adds simulated scenes; all count
    together.

    Without the real scenes nothing is drawn, the goals stay open, and a note says why.
    """
    real, model = real_true_scenes(), shipped_model()
    total, done = len(real) + SCENES * repeats, 0
    found: dict[str, Found] = {where: {name: [] for name in METHODS} for where in (REAL, SIMULATED)}
    panels = []
    for where, scenes in ((REAL, real), (SIMULATED, simulated_true_scenes(SCENES * repeats))):
        for scene in scenes:
            results = {name: found_scene(scene, name, model) for name in METHODS}
            for name, result in results.items():
                found[where][name].append(result)
            if where == REAL and scene.name in DRAWN:
                panels.append((scene, results))
            done += 1
            progress(done, total, f"{where} scenes")
    if panels:
        _draw(panels, out)
    rows = [
        line
        for where, by_method in found.items()
        for name, results in by_method.items()
        for line in _rows(f"{name}, {where}", results)
    ]
    goals = _goals({line["name"]: line["value"] for line in rows})
    return {"rows": rows, "goals": goals} | ({} if real else {"notes": [NO_REAL_SCENES]})


def _rows(name: str, results: Sequence[FoundScene]) -> list[dict]:
    if not results:
        return []
    score = segmentation_score([result.overlaps for result in results])
    counts = np.array([(r.relations.right, r.relations.perceived, r.relations.true) for r in results], float)
    right, perceived, true = counts.T
    estimates = {
        "weighted overlap": score.weighted_overlap,
        "over-segmentation": score.over,
        "under-segmentation": score.under,
        "found": score.found,
        "relation precision": ratio_estimate(right, perceived),
        "relation recall": ratio_estimate(right, true),
        "relation F1": ratio_estimate(2 * right, perceived + true),
    }
    times = {
        "objects": median(result.seconds for result in results),
        "objects and relations": median(result.all_seconds for result in results),
    }
    return [
        *(estimated_row(f"{name}, {measure}", estimate, "share") for measure, estimate in estimates.items()),
        *_confidence_rows(name, results),
        *(row(f"{name}, processor time, {part}", 1e3 * seconds, "ms") for part, seconds in times.items()),
    ]


def _confidence_rows(name: str, results: Sequence[FoundScene]) -> list[dict]:
    """Whether cuts are right as often as their confidence says, by bands of confidence."""
    cuts = np.array([cut for result in results for cut in result.cuts], float).reshape(-1, 2)
    rows = []
    for low, high in pairwise(BANDS):
        band = cuts[(cuts[:, 0] >= low) & (cuts[:, 0] < high)]
        if len(band):
            label = f"{name}, cut confidence {low:g} to {min(high, 1):g}"
            rows.append(row(f"{label}, mean", float(band[:, 0].mean()), "share") | {"n": len(band)})
            rows.append(row(f"{label}, right", float(band[:, 1].mean()), "share") | {"n": len(band)})
    return rows


def _goals(value: dict[str, float]) -> list[dict]:
    """Of convexity on the real scenes."""
    name = f"convexity, {REAL}"
    return [
        at_least(f"{name}, weighted overlap", 0.90, value.get(f"{name}, weighted overlap")),
        at_most(f"{name}, over-segmentation", 0.08, value.get(f"{name}, over-segmentation")),
        at_most(f"{name}, under-segmentation", 0.04, value.get(f"{name}, under-segmentation")),
        at_least(f"{name}, found", 0.95, value.get(f"{name}, found")),
        at_least(f"{name}, relation F1", 0.65, value.get(f"{name}, relation F1")),
        at_most(f"{name}, processor time, ms", 400, value.get(f"{name}, processor time, objects and relations")),
    ]


def _draw(panels: Sequence[tuple[TrueScene, dict[str, FoundScene]]], out: Path) -> None:
    from lifelore.figures.scenes.segmentation_panels import draw_segmentations
    from lifelore.figures.style import save_figure

    rows = []
    for scene, results in panels:
        # A fifth picture in a row would be too small to see; cuts at every edge are easy to imagine.
        names = [GIVEN, *(name for name in METHODS if name not in (GIVEN, CURVATURE))]
        clouds = {name: results[name].cloud for name in names}
        rows.append((scene.name, true_labels(scene), clouds))
    save_figure(draw_segmentations(rows), out / "segmentation.png")
