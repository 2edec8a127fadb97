"""C4.10: the regret of letting one task, the landmark, stand for all tasks of its type.

Definition 4.3.3 calls tasks a type when no policy's utility differs by more than ε between any two of them; it
bounds the landmark's regret by ε, but only 2 ε can be proved. Thesis: §4.3.3, Def. 4.3.3, Figure 4.2(b).

Tables of utilities of policies on tasks come in families: ``uniform``, every utility drawn alone; ``smooth``,
tasks on a line and each policy a sum of waves over it, as in Figure 4.1; ``clustered``, tasks drawn around the
centres of types; ``surveillance``, the reserve's own table, of the 68 targets or of all cells near a hill. ε is a
share of the table's range. Tasks alone in their type stand for themselves and cost nothing: only tasks that share
a type are counted.
"""

from collections.abc import Mapping
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction.library.task_types import TaskTypes, epsilon_types, landmark_regret, member_regret

Array = NDArray[np.float64]

RANDOM = ("uniform", "smooth", "clustered")
SURVEILLANCE = "surveillance"
CHUNK = 10
BINS = 20
"""Bins of regret / ε from 0 to 2; exact zeros are counted apart."""
TOLERANCE = 1e-9
"""Regrets are differences of floats: past ε means past (1 + this) ε."""
WAVES = 4


def check(settings: Mapping) -> None:
    if "pairwise" not in settings["forms"]:
        raise InputError(f"forms must include 'pairwise', got {settings['forms']}")


def cells(settings: Mapping) -> list[dict]:
    """Random tables in lots, and each of the reserve's tables."""
    starts = range(0, settings["tables"], CHUNK)
    drawn = [
        {"family": family, "policies": n, "first": first, "last": min(first + CHUNK, settings["tables"])}
        for family, n, first in product(settings["families"], settings["policies"], starts)
    ]
    reserve = [
        {"family": SURVEILLANCE, "layout": layout, "metric": metric, "tasks": tasks}
        for layout, metric, tasks in product(settings["layouts"], settings["metrics"], ("targets", "cells"))
    ]
    return drawn + reserve


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The tables of one lot, parted in every way."""
    if cell["family"] == SURVEILLANCE:
        tables = [surveillance_table(cell["layout"], cell["metric"], cell["tasks"])]
    else:
        family, n = cell["family"], cell["policies"]
        streams = (stream(seed, "C4.10", family, n, number) for number in range(cell["first"], cell["last"]))
        tables = [random_table(generator, family, settings["tasks"], n) for generator in streams]
    found = [
        parted(table, share, form) | {"table": place}
        for place, table in enumerate(tables)
        for share, form in product(settings["shares"], settings["forms"])
    ]
    return {"cell": dict(cell), "parted": found}


def random_table(generator: np.random.Generator, family: str, n_tasks: int, n_policies: int) -> Array:
    """One table of a family, (n_tasks, n_policies)."""
    if family == "uniform":
        return generator.random((n_tasks, n_policies))
    if family == "smooth":
        place = np.linspace(0, 1, n_tasks)[:, None, None]
        frequency = generator.uniform(0.3, 3.0, (n_policies, WAVES))
        phase = generator.uniform(0, 2 * np.pi, (n_policies, WAVES))
        height = generator.normal(size=(n_policies, WAVES))
        return (height * np.sin(2 * np.pi * frequency * place + phase)).sum(axis=-1)
    centres = generator.random((max(2, n_tasks // 20), n_policies))
    return centres[generator.integers(len(centres), size=n_tasks)] + generator.normal(
        0, 0.05, (n_tasks, n_policies)
    )


def surveillance_table(layout: str, metric: str, tasks: str) -> Array:
    """Expected pay with the poachers at each of the 68 ``targets``, or at any of the ``cells`` near a hill."""
    world = Surveillance(layout=layout, metric=metric)
    return world.mean if tasks == "targets" else world.mean_at(world.cells_near_hills)


def parted(table: Array, share: float, form: str) -> dict:
    """A table parted into types of size ε = `share` of its range, and the regret of landmarks on its tasks, in ε.

    ``landmark``: the member in the middle stands for the type; ``member``: the one that costs each task most.
    """
    epsilon = share * float(table.max() - table.min())
    types: TaskTypes = epsilon_types(table, epsilon, form)  # pyright: ignore[reportArgumentType]
    shared = np.bincount(types.labels)[types.labels] > 1
    found: dict = {"share": share, "form": form, "types": types.n_types, "shared": int(shared.sum())}
    regrets = {"landmark": landmark_regret(table, types)}
    if form == "pairwise":
        # Only there are any two members within ε of each other.
        regrets["member"] = member_regret(table, types)
    return found | {name: _summary(regret[shared] / epsilon) for name, regret in regrets.items()}


def _summary(ratio: Array) -> dict:
    """Regret in ε over tasks: sum, largest, how many past ε, none at all, and a histogram of the rest."""
    none = ratio <= TOLERANCE
    counts, _ = np.histogram(np.minimum(ratio[~none], 2.0), bins=BINS, range=(0, 2))
    return {
        "sum": float(ratio.sum()),
        "largest": float(ratio.max(initial=0.0)),
        "past": int((ratio > 1 + TOLERANCE).sum()),
        "none": int(none.sum()),
        "counts": counts.tolist(),
    }
