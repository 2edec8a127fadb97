"""C4.10: the regret of letting one task, the landmark, stand for all tasks of its type.

Definition 4.3.3 calls tasks a type when no policy's utility differs by more than ε between any two of them; it
bounds the landmark's regret by ε, but only 2 ε can be proved. Thesis: §4.3.3, Def. 4.3.3, Figure 4.2(b).
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter4.c4_10_landmark_regret.landmark_tables import SURVEILLANCE, run_tables

CHUNK = 10


def check(settings: Mapping) -> None:
    if "pairwise" not in settings["forms"]:
        raise InputError(f"forms must include 'pairwise', got {settings['forms']}")


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
