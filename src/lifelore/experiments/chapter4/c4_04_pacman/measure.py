"""C4.4: powers of ten between the episodes that policy reuse and the learners need."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.pacman.pacman import STRATEGIES
from lifelore.experiments.chapter4.c4_04_pacman.pacman_reuse import (
    BPR,
    BPR_EI,
    BPR_EXACT,
    BPR_MORE,
    DISCOUNTED,
    LEARNERS,
    PRQ,
    PRQ_SCALED,
    Q,
)
from lifelore.experiments.engine.curve_blocks import block_edges
from lifelore.experiments.engine.estimates import exact_value

REUSERS = (BPR, BPR_EI, BPR_MORE, BPR_EXACT)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Share of tasks on which each method gets there, powers of ten between them, training, and moved foods."""

    def orders(kind: str, names: Sequence[str], reuser: str = BPR) -> Estimate:
        """Mean power of ten between the fastest of some learners on each task and a form of BPR; over layouts."""
        powers = []
        for cell in results:
            slow = np.min([_episodes(settings, cell, kind, name) for name in names], axis=0)
            powers.append(np.log10(slow / _episodes(settings, cell, "needed", reuser)).mean())
        return mean_estimate(powers)

    found = {
        f"reached_{name}": _layout_means(
            results, "tasks", lambda task, name=name: task["needed"][name] is not None
        )
        for name in (*REUSERS, *LEARNERS)
    }
    learners = {"q": (Q,), "prq": (PRQ, PRQ_SCALED)}
    for extra in ("", DISCOUNTED):
        for title, names in learners.items():
            variants = [name + extra for name in names]
            found[f"orders_{title}{extra}"] = orders("needed", variants)
            found[f"orders_greedy_{title}{extra}"] = orders("greedy", variants)
    found["orders_prq_as_returned"] = orders("needed", [PRQ])
    for title, names in learners.items():
        found[f"orders_{title}_more_samples"] = orders("needed", names, BPR_MORE)
    found["library_return"] = _layout_means(results, "tasks", lambda task: task["best"])
    spent = len(STRATEGIES) * settings["training_episodes"] + len(STRATEGIES) ** 2 * settings["samples"]
    found["training_episodes"] = exact_value(spent, len(results))
    for name in ("best", BPR, *LEARNERS):
        found[f"moved_{name}"] = _layout_means(results, "moved", lambda task, name=name: task[name])
    return found


def _episodes(settings: Mapping, cell: Mapping, kind: str, name: str) -> NDArray[np.float64]:
    """Episodes needed, by task; all of them where they were not enough."""
    return np.array([task[kind][name] or settings["episodes"] for task in cell["tasks"]], float)


def _layout_means(results: Sequence[Mapping], key: str, number: Callable[[Mapping], float]) -> Estimate:
    """Mean over layouts of the mean over a layout's tasks."""
    return mean_estimate([np.mean([number(task) for task in cell[key]]) for cell in results])


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a layout, with its library; a row a task; then curves, mean and standard deviation over tasks."""
    found: list[dict] = [{key: cell[key] for key in ("layout", "foods", "mean", "deviation")} for cell in results]
    for cell in results:
        for task, moved in zip(cell["tasks"], cell["moved"], strict=True):
            kept = {key: task[key] for key in ("type", "best", "needed", "greedy")}
            found.append({"task_of": cell["layout"], **kept, "moved": moved})
    found.append({"curve_edges": block_edges(settings["episodes"]).tolist()})
    for name in (BPR, PRQ, Q):
        curves = np.array([task["curves"][name] for cell in results for task in cell["tasks"]])
        mean, deviation = curves.mean(axis=0), curves.std(axis=0, ddof=1)
        found.append({"curve_of": name, "mean": mean.round(1).tolist(), "deviation": deviation.round(1).tolist()})
    return found
