"""Measures and rows of claim C2.8."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.experiments.chapter2.c2_08_oversegmented_object.run import TRUE
from lifelore.experiments.engine.estimates import UNMEASURED, exact_share, mean_or_unmeasured

SETS = {"simulated": False, "real": True}
METHODS = {"": "said", "_by_boxes": "boxes"}
TABLE_TRUE = {"level": ["none", "on"], "upright": ["on", "on"]}
RESAMPLES = 1000


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Recall of either relation, share right, macro F1, and relations with the table, by set of scenes."""
    found = {}
    for name, real in SETS.items():
        rows = [row for result in results if result["real"] == real for row in result["rows"]]
        judged = [row for row in rows if row["kind"] in TRUE]
        share = shared_by_scene if real else exact_share_of_rows
        for suffix, method in METHODS.items():
            for kind, true in TRUE.items():
                own = [row for row in judged if row["kind"] == kind]
                found[f"{true}_right_{name}{suffix}"] = share(own, [row[method] == true for row in own])
            right = [row[method] == TRUE[row["kind"]] for row in judged]
            found[f"right_{name}{suffix}"] = shared_by_scene(judged, right)
            found[f"macro_f1_{name}{suffix}"] = macro_f1(judged, method)
        right = [row["table"] == TABLE_TRUE[row["kind"]] for row in judged]
        found[f"table_right_{name}"] = shared_by_scene(judged, right)
        oblique = [row for row in rows if row["kind"] == "oblique"]
        for low, high in ((15, 45), (45, 75)):
            own = [row for row in oblique if low <= row["tilt"] < high]
            on = exact_share(row["said"] in ("on", "both") for row in own)
            found[f"oblique_{low}_to_{high}_degrees_on_or_both_{name}"] = on
    tilts = [row["tilt"] for result in results for row in result["rows"] if row["kind"] == "oblique"]
    found["mean_tilt_of_oblique_cuts"] = mean_or_unmeasured(tilts)
    return found


def exact_share_of_rows(rows: Sequence[Mapping], answers: Sequence[bool]) -> Estimate:
    """Share of rows that are each of a scene of their own."""
    return exact_share(answers)


def shared_by_scene(rows: Sequence[Mapping], answers: Sequence[bool]) -> Estimate:
    """Share of true answers, scenes resampled; with the exact interval where all answers are one."""
    if not rows:
        return UNMEASURED
    totals: dict[str, list[int]] = {}
    for row, answer in zip(rows, answers, strict=True):
        sums = totals.setdefault(row["scene"], [0, 0])
        sums[0] += answer
        sums[1] += 1
    counts = np.array(list(totals.values()), float)
    clustered, plain = ratio_estimate(counts[:, 0], counts[:, 1]), exact_share(answers)
    interval = clustered.ci95 if 0 < plain.value < 1 else plain.ci95
    return Estimate(plain.value, clustered.median, interval or plain.ci95, plain.n)


def macro_f1(rows: Sequence[Mapping], method: str) -> Estimate:
    """Mean F1 of *on* and *adjacent* over level and upright cuts, scenes resampled (percentiles)."""
    if not rows:
        return UNMEASURED
    names = sorted({row["scene"] for row in rows})
    # Of each scene and relation: right, said, true.
    counts = np.zeros((len(names), len(TRUE), 3))
    for row in rows:
        for number, (kind, true) in enumerate(TRUE.items()):
            of, said = row["kind"] == kind, row[method] == true
            counts[names.index(row["scene"]), number] += (of and said, said, of)
    drawn = stream(len(names), "scenes resampled").multinomial(
        len(names), np.full(len(names), 1 / len(names)), size=RESAMPLES
    )
    resampled = _mean_f1(np.tensordot(drawn.astype(float), counts, axes=1))
    low, high = np.quantile(resampled, [0.025, 0.975])
    value = float(_mean_f1(counts.sum(axis=0)[None])[0])
    return Estimate(value, value, (float(low), float(high)) if low < high else None, len(rows))


def _mean_f1(counts: NDArray[np.float64]) -> NDArray[np.float64]:
    right, said, true = np.moveaxis(counts, -1, 0)
    return (2 * right / np.maximum(said + true, 1)).mean(axis=1)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How often what was said, by set of scenes and kind of cut (oblique ones in steps of 15°); and pictures."""
    counts: dict[tuple, int] = {}
    for result in results:
        for row in result["rows"]:
            low = 15 * min(int(row["tilt"] // 15), 5)
            cut = row["kind"] if row["kind"] in TRUE else f"{low}° to {low + 15}°"
            key = ("real" if result["real"] else "simulated", cut, row["said"], row["boxes"])
            counts[key] = counts.get(key, 0) + 1
    counted = [
        {"set": name, "cut": cut, "said": said, "boxes": boxes, "cuts": n}
        for (name, cut, said, boxes), n in sorted(counts.items())
    ]
    return counted + [example for result in results for example in result["examples"]]
