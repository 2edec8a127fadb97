"""`bench plans`: plans made from perceived scenes, checked by the truth, at each least probability of a fact.

For every object near another, a plan fetches it (`fetch_plan`) from the facts that are stated at a threshold. The
plan is valid if no object has anything on it when it is picked up, by the forces of the simulation, or by the
hand-made labels of confidence 2 and 3. A higher threshold gives fewer plans, of which more are valid.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.metrics import Estimate
from lifelore.core.protocols import Progress
from lifelore.core.relations import PairLabel
from lifelore.domains.tabletop.tabletop import TabletopSettings, tabletop_scenes
from lifelore.experiments.bench.perception.fetch_plan import fetch_order, is_valid
from lifelore.experiments.bench.perception.relation_scenes import HELD_OUT
from lifelore.experiments.bench.rounds import at_least, row
from lifelore.experiments.chapter2.scenes.real_scenes import real_scenes, real_scenes_folder
from lifelore.experiments.chapter2.scoring.relation_scoring import share_over_scenes
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.reasoning.hidden_tops import hidden_tops
from lifelore.perception.reasoning.label_distribution import label_distributions
from lifelore.perception.reasoning.planning_state import PLAN_CONFIDENCE, planning_state
from lifelore.perception.reasoning.scene_logic import alternatives
from lifelore.perception.relations.relation_classifier import shipped_model

THRESHOLDS = (0.0, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 0.98)
SCENES = 40
"""Simulated scenes a round; two to seven objects each."""
SIMULATED, REAL = "simulated", "real"
UNKNOWN, AS_CLEAR = "hidden tops unknown", "hidden tops taken as clear"
OUT = Path("results")
Key = tuple[str, float]
"""How hidden tops count, and the threshold."""


@dataclass(frozen=True)
class Fetched:
    """Counts of a scene: objects to fetch, and by `Key` the plans and the valid ones among them."""

    targets: int
    plans: Mapping[Key, tuple[int, int]]


def bench_plans(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `lifelore.experiments.bench.bench`. Each round adds simulated scenes.

    With two rounds or more, the figure ``bench_plans.png`` is drawn in `out`.
    """
    n = SCENES * repeats
    real = real_scenes() if real_scenes_folder() else ()
    seed, shapes = HELD_OUT
    fetched: dict[str, list[Fetched]] = {SIMULATED: [], REAL: []}
    for scene in tabletop_scenes(n, seed, TabletopSettings(shapes=shapes)):
        fetched[SIMULATED].append(fetched_in(scene.cloud, scene.truth))
        progress(len(fetched[SIMULATED]), n + len(real), "simulated scenes")
    for scene in real:
        fetched[REAL].append(fetched_in(scene.cloud, scene.truth))
        progress(n + len(fetched[REAL]), n + len(real), "real scenes")
    rows, goals = [], []
    if repeats > 1:
        _draw(fetched, out)
    for where, scenes in fetched.items():
        for key in [(hidden, least) for hidden in (UNKNOWN, AS_CLEAR) for least in THRESHOLDS]:
            planned, valid, useful = shares(scenes, key)
            name = f"{where}, {key[0]}, from {key[1]:g}"
            rows += [
                _row(f"{name}: objects with a plan", planned),
                _row(f"{name}: valid plans", valid),
                _row(f"{name}: objects with a valid plan", useful),
            ]
        _, valid, _ = shares(scenes, (UNKNOWN, PLAN_CONFIDENCE))
        measured = valid.value if valid.n else None
        goals.append(at_least(f"{where}, default threshold {PLAN_CONFIDENCE:g}: valid plans", 0.95, measured))
    return {"rows": rows, "goals": goals}


def fetched_in(cloud: LabelledCloud, truth: Iterable[PairLabel]) -> Fetched:
    """The plans for a scene, which the shipped model perceives."""
    truth = tuple(truth)
    scene = perceived_scene(cloud, shipped_model())
    targets = sorted({end for i in scene.interfaces if TABLE not in (i.a, i.b) for end in (i.a, i.b)})
    beliefs = label_distributions(alternatives(scene.beliefs))
    hidden = {UNKNOWN: hidden_tops(cloud), AS_CLEAR: ()}
    plans = {}
    for way, tops in hidden.items():
        for least in THRESHOLDS:
            state = planning_state(scene.relations, scene.objects, least, beliefs, tops)
            orders = [order for target in targets if (order := fetch_order(state, target)) is not None]
            plans[way, least] = len(orders), sum(is_valid(order, truth) for order in orders)
    return Fetched(len(targets), plans)


def shares(scenes: Iterable[Fetched], key: Key) -> tuple[Estimate, Estimate, Estimate]:
    """Share of objects with a plan, of plans that are valid, of objects with a valid plan; scenes resampled."""
    counts = [(scene.targets, *scene.plans[key]) for scene in scenes]
    targets, planned, valid = zip(*counts, strict=True) if counts else ((), (), ())
    return (
        share_over_scenes(planned, targets),
        share_over_scenes(valid, planned),
        share_over_scenes(valid, targets),
    )


def _row(name: str, estimate: Estimate) -> dict:
    value = estimate.value if estimate.n else None
    return row(name, value, "share") | {"ci95": estimate.to_dict()["ci95"], "n": estimate.n}


def _draw(fetched: Mapping[str, Sequence[Fetched]], out: Path) -> None:
    from lifelore.experiments.bench.perception.figure_plan_validity import draw_plan_validity
    from lifelore.figures.style import save_figure

    out.mkdir(parents=True, exist_ok=True)
    panels = {
        f"{len(scenes)} {where} scenes": (_series(scenes, UNKNOWN), _series(scenes, AS_CLEAR))
        for where, scenes in fetched.items()
        if scenes
    }
    save_figure(draw_plan_validity(THRESHOLDS, PLAN_CONFIDENCE, panels), out / "bench_plans.png")


def _series(scenes: Sequence[Fetched], hidden: str) -> dict[str, list[float]]:
    found = [shares(scenes, (hidden, least)) for least in THRESHOLDS]
    ends = [valid.ci95 or (valid.value, valid.value) for _, valid, _ in found]
    return {
        "planned": [planned.value for planned, _, _ in found],
        "valid": [valid.value for _, valid, _ in found],
        "low": [low for low, _ in ends],
        "high": [high for _, high in ends],
    }
