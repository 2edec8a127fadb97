"""C4.10: what it costs to let one task, the landmark, stand for all tasks of its type.

Definition 4.3.3 calls tasks a type when no policy's utility differs by more than ε between any two; representing
all of them by any one "cannot be more than ε" in regret. Random tables of utilities and the reserve's own are
parted into types of several sizes, and the regret of playing the landmark's best policy on each task is set
against ε and 2 ε, the bound that can be proved. Thesis: §4.3.3, Def. 4.3.3, Figure 4.2(b).
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter4.c4_10_landmark_regret.landmark_tables import (
    BINS,
    RANDOM,
    SURVEILLANCE,
    run_tables,
)
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.predicate import Predicate
from lifelore.interaction.library.task_types import epsilon_types, landmark_regret

CHUNK = 10
WHO = ("landmark", "member")
"""Who stands for a type: the member in the middle, or for each task the one that costs it most."""
EXAMPLE = ((10.0, 10.0), (9.0, 11.0))
"""Two tasks within ε = 1 of each other, the first the landmark: its best policy costs 2 ε on the second."""

FULL = {
    "tables": 100,
    "tasks": 200,
    "policies": [2, 4, 16],
    "families": list(RANDOM),
    "layouts": ["X", "diamond", "ring", "checkerboard"],
    "metrics": ["chebyshev", "euclidean"],
    "shares": [0.02, 0.05, 0.1, 0.2, 0.3, 0.4],
    "forms": ["pairwise", "ball"],
}
QUICK = {**FULL, "tables": 4, "tasks": 60, "policies": [2, 4], "layouts": ["X"], "metrics": ["chebyshev"]}


def _check(settings: Mapping) -> None:
    for key in ("families", "policies", "shares", "forms"):
        if not settings[key]:
            raise InputError(f"{key} must name at least one, got none")
    if set(settings["families"]) - set(RANDOM):
        raise InputError(f"families must be among {', '.join(RANDOM)}, got {settings['families']}")
    if settings["tables"] < 1 or settings["tasks"] < 2 or min(settings["policies"]) < 1:
        raise InputError("tables and policies must be at least 1, tasks at least 2")
    if not all(0 < share <= 1 for share in settings["shares"]) or "pairwise" not in settings["forms"]:
        raise InputError("shares must lie in (0, 1], and forms hold 'pairwise'")


def cells(settings: Mapping) -> list[dict]:
    """Random tables in lots, and each of the reserve's tables."""
    lots = [(first, min(first + CHUNK, settings["tables"])) for first in range(0, settings["tables"], CHUNK)]
    drawn = [
        {"family": family, "policies": n, "first": first, "last": last}
        for family in settings["families"]
        for n in settings["policies"]
        for first, last in lots
    ]
    reserve = [
        {"family": SURVEILLANCE, "layout": layout, "metric": metric, "tasks": tasks}
        for layout in settings["layouts"]
        for metric in settings["metrics"]
        for tasks in ("targets", "cells")
    ]
    return drawn + reserve


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The tables of one lot, parted."""
    return {"cell": dict(cell), "parted": run_tables(settings, cell, seed)}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Regret in ε: largest of all, share of tasks (that share a type) within ε, and both by family."""
    every = _all(results)
    largest = np.array([p[who]["largest"] for _, p in every for who in WHO if who in p] + [example_regret()])
    found = {
        "largest_regret_in_epsilon": _largest(largest),
        "largest_regret_in_two_epsilon": _largest(largest / 2),
        "regret_of_the_example_in_epsilon": _largest(np.array([example_regret()])),
    }
    pairwise = [(cell, p) for cell, p in every if p["form"] == "pairwise"]
    drawn = [(cell, p) for cell, p in pairwise if cell["family"] != SURVEILLANCE]
    for who in WHO:
        found[f"tasks_within_epsilon_{who}"] = mean_estimate(_within(drawn, who))
    for family in (*settings["families"], SURVEILLANCE):
        own = [(cell, p) for cell, p in pairwise if cell["family"] == family]
        for who in WHO:
            if within := _within(own, who):
                found[f"tasks_within_epsilon_{who}_{family}"] = mean_estimate(within)
            found[f"largest_regret_in_epsilon_{who}_{family}"] = _largest(
                np.array([p[who]["largest"] for _, p in own])
            )
    return found


def _all(results: Sequence[Mapping]) -> list[tuple[Mapping, Mapping]]:
    return [(result["cell"], found) for result in results for found in result["parted"]]


def _within(found: Sequence[tuple[Mapping, Mapping]], who: str) -> list[float]:
    """Share of tasks that cost at most ε, by table: tables are drawn alone, the tasks of one are not."""
    tables: dict[tuple, list[int]] = {}
    for cell, parted in found:
        past = tables.setdefault((*map(str, cell.values()), parted["table"]), [0, 0])
        past[0] += parted[who]["past"]
        past[1] += parted["shared"]
    return [1 - past / shared for past, shared in tables.values() if shared]


def _largest(values: np.ndarray) -> Estimate:
    """The largest of all beside their median; a largest value has no interval."""
    return Estimate(float(values.max()), float(np.median(values)), None, len(values))


def example_regret() -> float:
    """What the landmark's best policy costs on the second task of `EXAMPLE`, in ε."""
    return float(landmark_regret(EXAMPLE, epsilon_types(EXAMPLE, 1.0)).max())


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """By family, number of policies (or the reserve's table), ε and form: types and regrets in ε."""
    groups: dict[tuple, list[Mapping]] = {}
    for cell, found in _all(results):
        kind = {key: cell[key] for key in ("family", "policies", "layout", "metric", "tasks") if key in cell}
        key = (tuple(kind.items()), found["share"], found["form"])
        groups.setdefault(key, []).append(found)
    return [
        dict(kind) | {"epsilon": share, "form": form} | _row(found)
        for (kind, share, form), found in groups.items()
    ]


def _row(found: Sequence[Mapping]) -> dict:
    shared = sum(f["shared"] for f in found)
    row: dict = {"tables": len(found), "types": float(np.mean([f["types"] for f in found])), "shared": shared}
    for who in WHO:
        own = [f[who] for f in found if who in f]
        if own:
            row[who] = {
                "mean": sum(o["sum"] for o in own) / max(shared, 1),
                "largest": max(o["largest"] for o in own),
                "past": sum(o["past"] for o in own) / max(shared, 1),
                "none": sum(o["none"] for o in own),
                "counts": np.sum([o["counts"] for o in own], axis=0).tolist(),
            }
    return row


def _draw(result: Mapping):
    from lifelore.experiments.chapter4.c4_10_landmark_regret.figure_landmark_regret import draw_landmark_regret

    return draw_landmark_regret(result["rows"], EXAMPLE, BINS)


CLAIM = Claim(
    id="C4.10",
    title="What a landmark costs the tasks of its type (Definition 4.3.3)",
    thesis="The regret of representing all the MDPs of an ε-type with any one of them, the landmark, cannot be "
    "more than ε.",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C4.10"),
    cells=cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes={
        "no task costs more than epsilon": "the policy played may be worth ε less than on the landmark and the "
        "task's own best ε more, 2 ε together"
    },
    check=_check,
)
