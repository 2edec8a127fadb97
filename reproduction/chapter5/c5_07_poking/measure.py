"""Measures and rows of claim C5.7: segmentation before and after pushes, over the same clouds."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, ratio_estimate
from reproduction.chapter2.scoring.segmentation_scoring import FOUND
from reproduction.chapter5.c5_07_poking.run import KINDS
from reproduction.engine.estimates import UNMEASURED


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """All scenes together, and by kind; intervals resample scenes."""
    scenes = [scene for result in results for scene in result["scenes"]]
    found = measures_of(scenes)
    for kind in KINDS:
        own = measures_of([scene for scene in scenes if scene["kind"] == kind])
        found |= {f"{name}_{kind}": number for name, number in own.items()}
    return found


def measures_of(scenes: Sequence[Mapping]) -> dict[str, Estimate]:
    """Overlap, objects found, gains, and whether merges and splits were right."""
    objects = [np.array(scene["objects"], float).reshape(-1, 3) for scene in scenes]
    points = [o[:, 0].sum() for o in objects]
    hit = [o[:, 1:] >= FOUND for o in objects]
    return {
        "overlap_before": _share([(o[:, 0] * o[:, 1]).sum() for o in objects], points),
        "overlap_after": _share([(o[:, 0] * o[:, 2]).sum() for o in objects], points),
        "overlap_gain": _share([(o[:, 0] * (o[:, 2] - o[:, 1])).sum() for o in objects], points),
        "found_before": _share([h[:, 0].sum() for h in hit], [len(h) for h in hit]),
        "found_after": _share([h[:, 1].sum() for h in hit], [len(h) for h in hit]),
        "found_gain": _share([h[:, 1].sum() - float(h[:, 0].sum()) for h in hit], [len(h) for h in hit]),
        "corrected": _share([(~h[:, 0] & h[:, 1]).sum() for h in hit], [(~h[:, 0]).sum() for h in hit]),
        "spoiled": _share([(h[:, 0] & ~h[:, 1]).sum() for h in hit], [h[:, 0].sum() for h in hit]),
        "merges_right": _share(*zip(*(scene["merges"] for scene in scenes), strict=True)),
        "splits_right": _share(*zip(*(scene["splits"] for scene in scenes), strict=True)),
        "changed_unpoked": _share([scene["still"] for scene in scenes], [scene["segments"] for scene in scenes]),
        "pokes": _share([scene["pokes"] for scene in scenes], [1] * len(scenes)),
    }


def _share(parts: Sequence, wholes: Sequence) -> Estimate:
    """Ratio of sums over scenes; `UNMEASURED` where there is nothing to divide by."""
    whole = np.asarray(wholes, float)
    return ratio_estimate(np.asarray(parts, float)[whole > 0], whole[whole > 0]) if whole.sum() > 0 else UNMEASURED


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Every scene, and for each kind the data of a picture: the first scene that pushes changed, or the first."""
    scenes = [scene for result in results for scene in result["scenes"]]
    pictures = [example for result in results for example in result["examples"]]
    own = {kind: [p for p in pictures if p["example"] == kind] for kind in KINDS}
    return scenes + [max(found, key=lambda p: p["changed"]) for found in own.values() if found]
