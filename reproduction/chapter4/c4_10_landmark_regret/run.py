"""C4.10: the regret of letting any one task, the landmark, stand for all tasks of its type.

Definition 4.3.3 calls tasks a type when no policy's utility differs by more than ε between any two of them. Tables
of utilities are smooth ones, tasks on a line and each policy a sum of waves over it, as in Figure 4.1, and those
of the surveillance reserve with the poachers at any cell near a hill. ε is a share of the table's range. Tasks
alone in their type are not counted. Thesis: §4.3.3, Def. 4.3.3, Figure 4.2(b).
"""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import Surveillance
from lifelore.interaction.library.task_types import TaskTypes, epsilon_types
from reproduction.engine.estimates import exact_value, mean_or_unmeasured

Array = NDArray[np.float64]
EXAMPLE = ((10.0, 10.0), (9.0, 11.0))
"""Two policies on two tasks within ε = 1 of each other: a best policy of the first costs 2 ε on the second."""
SMOOTH, RESERVE = "smooth", "surveillance"
WAVES = 4


def cells(settings: Mapping) -> list[dict]:
    """The random tables, and the reserve's."""
    drawn = [{"family": SMOOTH, "number": number} for number in range(settings["tables"])]
    reserves = product(settings["layouts"], settings["metrics"])
    return [*drawn, *({"family": RESERVE, "layout": layout, "metric": metric} for layout, metric in reserves)]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The regrets of a table parted into types of each size."""
    if cell["family"] == SMOOTH:
        table = smooth_table(stream(seed, "C4.10", cell["number"]), settings["tasks"], settings["policies"])
    else:
        world = Surveillance(cell["layout"], cell["metric"])
        table = world.mean_at(world.cells_near_hills)
    return {**cell, "parted": [parted(table, share) for share in settings["shares"]]}


def smooth_table(generator: np.random.Generator, n_tasks: int, n_policies: int) -> Array:
    """Utilities of policies that vary smoothly over tasks on a line, (n_tasks, n_policies)."""
    place = np.linspace(0, 1, n_tasks)[:, None, None]
    frequency = generator.uniform(0.3, 3.0, (n_policies, WAVES))
    phase = generator.uniform(0, 2 * np.pi, (n_policies, WAVES))
    height = generator.normal(size=(n_policies, WAVES))
    return (height * np.sin(2 * np.pi * frequency * place + phase)).sum(axis=-1)


def parted(table: Array, share: float) -> dict:
    """The regret of each task that shares a type, in ε = `share` of the range, the worst member its landmark."""
    epsilon = share * float(np.ptp(table))
    types = epsilon_types(table, epsilon)
    regret = (member_regret(table, types) / epsilon)[np.bincount(types.labels)[types.labels] > 1]
    return {
        "shared": len(regret),
        "largest": round(float(regret.max(initial=0.0)), 9),
        "past": int((regret > 1 + 1e-9).sum()),
    }


def member_regret(utilities: Array, types: TaskTypes) -> Array:
    """The largest regret of each task's landmark over all choices of the landmark in its type, (n_tasks,)."""
    regret = np.zeros(len(utilities))
    for type_ in range(types.n_types):
        members = np.flatnonzero(types.labels == type_)
        own = utilities[members]
        for stands_for_all in own:
            left = own[:, stands_for_all == stands_for_all.max()].min(axis=1)
            regret[members] = np.maximum(regret[members], own.max(axis=1) - left)
    return regret


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The largest regret of all tables and the example, and the share of a smooth table's tasks within ε."""
    largest = [parted(np.array(EXAMPLE), 0.5)["largest"]]  # half the range is ε = 1
    largest += [one["largest"] for result in results for one in result["parted"]]
    within = []
    for result in results:
        past, shared = (sum(one[key] for one in result["parted"]) for key in ("past", "shared"))
        if result["family"] == SMOOTH and shared:
            within.append(1 - past / shared)
    return {"largest_regret": exact_value(max(largest), len(largest)), "within": mean_or_unmeasured(within)}
