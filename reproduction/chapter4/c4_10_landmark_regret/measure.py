"""C4.10: the largest regret of playing a landmark's best policy, in ε, and the share of tasks within ε."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.interaction.library.task_types import epsilon_types, landmark_regret
from reproduction.chapter4.c4_10_landmark_regret.run import SURVEILLANCE

ROLES = ("landmark", "member")
"""The task that stands for a type: its middle member, or for each task the member that costs it most."""
EXAMPLE = ((10.0, 10.0), (9.0, 11.0))
"""Two tasks within ε = 1 of each other, the first the landmark: its best policy costs 2 ε on the second."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    every = [(result["cell"], found) for result in results for found in result["parted"]]
    largest = np.array([p[role]["largest"] for _, p in every for role in ROLES if role in p] + [example_regret()])
    measured = {
        "largest_regret_in_epsilon": _largest(largest),
        "largest_regret_in_two_epsilon": _largest(largest / 2),
    }
    pairwise = [(cell, p) for cell, p in every if p["form"] == "pairwise"]
    families = {f"_{family}": (family,) for family in (*settings["families"], SURVEILLANCE)}
    for role in ROLES:
        for name, some in ({"": settings["families"]} | families).items():
            if within := _within([(cell, p) for cell, p in pairwise if cell["family"] in some], role):
                measured[f"tasks_within_epsilon_{role}{name}"] = mean_estimate(within)
    return measured


def _within(found: Sequence[tuple[Mapping, Mapping]], role: str) -> list[float]:
    """Share of tasks that cost at most ε, by table: tables are drawn alone, the tasks of a table are not."""
    tables: dict[tuple, list[tuple[int, int]]] = {}
    for cell, parted in found:
        counts = (parted[role]["past"], parted["shared"])
        tables.setdefault((*map(str, cell.values()), parted["table"]), []).append(counts)
    sums = (np.sum(counts, axis=0) for counts in tables.values())
    return [float(1 - past / shared) for past, shared in sums if shared]


def _largest(values: np.ndarray) -> Estimate:
    """The largest of all beside their median; a largest value has no interval."""
    return Estimate(float(values.max()), float(np.median(values)), None, len(values))


def example_regret() -> float:
    """Regret of the landmark's best policy on the second task of `EXAMPLE`, in ε."""
    return float(landmark_regret(EXAMPLE, epsilon_types(EXAMPLE, 1.0)).max())


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """By family, number of policies (or the reserve's table), ε and form: types and regrets in ε."""
    groups: dict[tuple, list[Mapping]] = {}
    for result in results:
        kind = [(key, value) for key, value in result["cell"].items() if key not in ("first", "last")]
        for found in result["parted"]:
            groups.setdefault((*kind, ("epsilon", found["share"]), ("form", found["form"])), []).append(found)
    return [dict(key) | _row(found) for key, found in groups.items()]


def _row(found: Sequence[Mapping]) -> dict:
    shared = sum(f["shared"] for f in found)
    row: dict = {"tables": len(found), "types": float(np.mean([f["types"] for f in found])), "shared": shared}
    for role in ROLES:
        if own := [f[role] for f in found if role in f]:
            total = {key: sum(o[key] for o in own) for key in ("sum", "past", "none")}
            row[role] = {
                "mean": total["sum"] / max(shared, 1),
                "largest": max(o["largest"] for o in own),
                "past": total["past"] / max(shared, 1),
                "none": total["none"],
                "counts": np.sum([o["counts"] for o in own], axis=0).tolist(),
            }
    return row
