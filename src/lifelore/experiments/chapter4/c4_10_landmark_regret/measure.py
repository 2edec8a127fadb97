"""C4.10: the largest regret of playing a landmark's best policy, in ε, and the share of tasks within ε."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter4.c4_10_landmark_regret.landmark_tables import SURVEILLANCE
from lifelore.interaction.library.task_types import epsilon_types, landmark_regret

WHO = ("landmark", "member")
"""The task that stands for a type: its middle member, or for each task the member that costs it most."""
EXAMPLE = ((10.0, 10.0), (9.0, 11.0))
"""Two tasks within ε = 1 of each other, the first the landmark: its best policy costs 2 ε on the second."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Regret in ε: the largest of all, and the share of tasks (that share a type) within ε, also by family."""
    every = [(result["cell"], found) for result in results for found in result["parted"]]
    largest = np.array([p[who]["largest"] for _, p in every for who in WHO if who in p] + [example_regret()])
    measured = {
        "largest_regret_in_epsilon": _largest(largest),
        "largest_regret_in_two_epsilon": _largest(largest / 2),
    }
    pairwise = [(cell, p) for cell, p in every if p["form"] == "pairwise"]
    for who in WHO:
        drawn = [(cell, p) for cell, p in pairwise if cell["family"] != SURVEILLANCE]
        measured[f"tasks_within_epsilon_{who}"] = mean_estimate(_within(drawn, who))
        for family in (*settings["families"], SURVEILLANCE):
            own = [(cell, p) for cell, p in pairwise if cell["family"] == family]
            if within := _within(own, who):
                measured[f"tasks_within_epsilon_{who}_{family}"] = mean_estimate(within)
    return measured


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
    """Regret of the landmark's best policy on the second task of `EXAMPLE`, in ε."""
    return float(landmark_regret(EXAMPLE, epsilon_types(EXAMPLE, 1.0)).max())


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """By family, number of policies (or the reserve's table), ε and form: types and regrets in ε."""
    groups: dict[tuple, list[Mapping]] = {}
    for cell, found in ((result["cell"], found) for result in results for found in result["parted"]):
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
