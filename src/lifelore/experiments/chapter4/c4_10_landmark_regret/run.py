"""C4.10: what it costs to let one task, the landmark, stand for all tasks of its type.

Definition 4.3.3 calls tasks a type when no policy's utility differs by more than ε between any two; representing
all of them by any one "cannot be more than ε" in regret. Random tables of utilities and the reserve's own are
parted into types of several sizes, and the regret of playing the landmark's best policy on each task is set
against ε and 2 ε, the bound that can be proved. Thesis: §4.3.3, Def. 4.3.3, Figure 4.2(b).
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter4.c4_10_landmark_regret.landmark_tables import RANDOM, SURVEILLANCE, run_tables

CHUNK = 10


def check(settings: Mapping) -> None:
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
