"""`bench plans`: plans made from perceived scenes, checked by the truth, at each least probability of a fact.

For every object near another, a plan fetches it (`fetch_plan`) from the facts that are stated at a threshold. The
plan is valid if no object has anything on it when it is picked up, by the forces of the simulation, or by the
hand-made labels of confidence 2 and 3. A higher threshold gives fewer plans, of which more are valid. The same
objects are fetched once with labels given, and once without labels (`fetched_scene`). The real scenes in which an
object has no valid plan are drawn.
"""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from benchmarks.perception.fetched_scene import (
    AS_CLEAR,
    NO_OBJECT,
    NO_PLAN,
    NOT_FOUND,
    THRESHOLDS,
    UNKNOWN,
    Fetched,
    Key,
    fetched_given,
    fetched_without_labels,
)
from benchmarks.perception.figure_plan_failures import FailedScene
from benchmarks.perception.relation_scenes import HELD_OUT
from benchmarks.perception.segmentation_scenes import (
    real_true_scenes,
    simulated_true_scene,
    true_labels,
)
from benchmarks.rounds import at_least, estimated_row, row
from lifelore.core.metrics import Estimate
from lifelore.core.protocols import Progress
from lifelore.domains.tabletop.tabletop import TabletopSettings, tabletop_scenes
from lifelore.perception.reasoning.planning_state import PLAN_CONFIDENCE
from reproduction.chapter2.scenes.real_scenes import real_scenes, real_scenes_folder
from reproduction.chapter2.scoring.relation_scoring import share_over_scenes

SCENES = 40
"""Simulated scenes a round; two to seven objects each."""
SIMULATED, REAL = "simulated", "real"
WITHOUT = " without labels"
OUT = Path("benchmarks/results")
DEFAULT = (UNKNOWN, PLAN_CONFIDENCE)


def bench_plans(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`. Each round adds simulated scenes.

    With two rounds or more, the figure ``bench_plans.png`` is drawn in `out`, and ``plans/failures.png`` if there
    are real scenes.
    """
    n = SCENES * repeats
    real = list(zip(real_scenes(), real_true_scenes(), strict=True)) if real_scenes_folder() else []
    seed, shapes = HELD_OUT
    fetched: dict[str, list[Fetched]] = {where + how: [] for how in ("", WITHOUT) for where in (SIMULATED, REAL)}
    failed: list[FailedScene] = []
    for scene in tabletop_scenes(n, seed, TabletopSettings(shapes=shapes)):
        targets, given = fetched_given(scene.cloud, scene.truth)
        fetched[SIMULATED].append(given)
        fetched[SIMULATED + WITHOUT].append(fetched_without_labels(simulated_true_scene(scene), targets)[1])
        progress(len(fetched[SIMULATED]), n + len(real), "simulated scenes")
    for labelled, scene in real:
        targets, given = fetched_given(labelled.cloud, labelled.truth)
        cut, without = fetched_without_labels(scene, targets)
        fetched[REAL].append(given)
        fetched[REAL + WITHOUT].append(without)
        if given.failures or without.failures:
            failed.append(
                FailedScene(
                    scene.name, true_labels(scene), (labelled.cloud, cut), (given.failures, without.failures)
                )
            )
        progress(n + len(fetched[REAL]), n + len(real), "real scenes")
    if repeats > 1:
        _draw(fetched, failed, out)
    rows = [line for where, scenes in fetched.items() for line in _rows(where, scenes)]
    return {"rows": rows, "goals": _goals(fetched)}


def shares(scenes: Iterable[Fetched], key: Key) -> tuple[Estimate, Estimate, Estimate]:
    """Share of objects with a plan, of plans that are valid, of objects with a valid plan; scenes resampled."""
    counts = [(scene.targets, *scene.plans[key]) for scene in scenes]
    targets, planned, valid = zip(*counts, strict=True) if counts else ((), (), ())
    return (
        share_over_scenes(planned, targets),
        share_over_scenes(valid, planned),
        share_over_scenes(valid, targets),
    )


def _rows(where: str, scenes: Sequence[Fetched]) -> list[dict]:
    """Rows at each threshold, and at the default threshold the reasons of failures."""
    rows = []
    for key in [(hidden, least) for hidden in (UNKNOWN, AS_CLEAR) for least in THRESHOLDS]:
        planned, valid, useful = shares(scenes, key)
        name = f"{where}, {key[0]}, from {key[1]:g}"
        rows += [
            estimated_row(f"{name}: objects with a plan", planned, "share"),
            estimated_row(f"{name}: valid plans", valid, "share"),
            estimated_row(f"{name}: objects with a valid plan", useful, "share"),
        ]
    reasons = [reason for scene in scenes for reason in scene.failures.values()]
    counts = {reason: reasons.count(reason) for reason in (NOT_FOUND, NO_PLAN, NO_OBJECT)}
    counts["another object rests on it"] = len(reasons) - sum(counts.values())
    return rows + [
        row(f"{where}, default threshold, failures: {reason}", count, "objects")
        for reason, count in counts.items()
    ]


def _goals(fetched: Mapping[str, Sequence[Fetched]]) -> list[dict]:
    """Of the plans at the default threshold."""
    goals = []
    for where in (SIMULATED, REAL):
        _, valid, _ = shares(fetched[where], DEFAULT)
        name = f"{where}, default threshold {PLAN_CONFIDENCE:g}"
        goals.append(at_least(f"{name}: valid plans", 0.95, valid.value if valid.n else None))
    for where, least in ((REAL, 0.95), (REAL + WITHOUT, 0.80)):
        _, _, useful = shares(fetched[where], DEFAULT)
        name = f"{where}, default threshold {PLAN_CONFIDENCE:g}"
        goals.append(at_least(f"{name}: objects with a valid plan", least, useful.value if useful.n else None))
    return goals


def _draw(fetched: Mapping[str, Sequence[Fetched]], failed: Sequence[FailedScene], out: Path) -> None:
    from benchmarks.perception.figure_plan_failures import draw_plan_failures
    from benchmarks.perception.figure_plan_validity import draw_plan_validity
    from lifelore.figures.style import save_figure

    out.mkdir(parents=True, exist_ok=True)
    panels = {
        f"{len(scenes)} {where} scenes" if WITHOUT not in where else f"{len(scenes)} scenes, {where}": (
            _series(scenes, UNKNOWN),
            _series(scenes, AS_CLEAR),
        )
        for where, scenes in fetched.items()
        if scenes
    }
    save_figure(draw_plan_validity(THRESHOLDS, PLAN_CONFIDENCE, panels), out / "bench_plans.png")
    if failed:
        save_figure(draw_plan_failures(failed), out / "plans" / "failures.png")


def _series(scenes: Sequence[Fetched], hidden: str) -> dict[str, list[float]]:
    found = [shares(scenes, (hidden, least)) for least in THRESHOLDS]
    ends = [valid.ci95 or (valid.value, valid.value) for _, valid, _ in found]
    return {
        "planned": [planned.value for planned, _, _ in found],
        "valid": [valid.value for _, valid, _ in found],
        "low": [low for low, _ in ends],
        "high": [high for _, high in ends],
    }
