"""C4.4: powers of ten between the episodes that policy reuse and the learners need."""

from collections.abc import Callable, Mapping, Sequence
from operator import itemgetter

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.pacman.pacman import STRATEGIES
from reproduction.chapter4.c4_04_pacman.run import (
    BPR,
    BPR_DOUBTING,
    BPR_EXACT,
    BPR_MIDDLE,
    BPR_MIDDLE_DOUBTING,
    BPR_MORE,
    BPR_MORE_DOUBTING,
    DISCOUNTED,
    LEARNERS,
    PRQ,
    PRQ_SCALED,
    REUSERS,
    Q,
)
from reproduction.engine.curve_blocks import block_edges
from reproduction.engine.estimates import exact_value, interval_or_value, share_of

SAMPLED = (BPR, BPR_MIDDLE, BPR_MORE, BPR_EXACT, BPR_DOUBTING, BPR_MIDDLE_DOUBTING, BPR_MORE_DOUBTING)
"""Belief sampling with each kind of models: of few, some and many samples, exact, and in doubt."""
ORDERS = 2.0
"""Powers of ten that count as orders of magnitude."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Share of tasks on which each method gets there, powers of ten between them, training, and moved foods."""

    def mean_over_layouts(key: str, number: Callable[[Mapping], float]) -> Estimate:
        return mean_estimate([np.mean([number(task) for task in cell[key]]) for cell in results])

    def orders(kind: str, names: Sequence[str], reuser: str = BPR, yardstick: str = "needed") -> Estimate:
        """Mean power of ten between the fastest of some learners on each task and a form of BPR; over layouts.

        `yardstick`: "needed", every expected return lasts, or "stretch", the learners' own: a mean of returns.
        """

        def power(task: Mapping) -> float:
            # All episodes where they were not enough.
            slow = min(task[kind][name] or settings["episodes"] for name in names)
            return np.log10(slow / (task[yardstick][reuser] or settings["episodes"]))

        return mean_over_layouts("tasks", power)

    def reached(name: str) -> Estimate:
        return mean_over_layouts("tasks", lambda task: task["needed"][name] is not None)

    found = {f"reached_{name}": reached(name) for name in (*REUSERS, *LEARNERS)}
    for title, names in {"q": (Q,), "prq": (PRQ, PRQ_SCALED)}.items():
        for extra in ("", DISCOUNTED):
            variants = [name + extra for name in names]
            found[f"orders_{title}{extra}"] = orders("needed", variants)
            found[f"orders_greedy_{title}{extra}"] = orders("greedy", variants)
        found[f"orders_{title}_more_samples"] = orders("needed", names, BPR_MORE)
        for yardstick in ("needed", "stretch"):
            found[f"orders_{title}_doubting_{yardstick}"] = orders("needed", names, BPR_DOUBTING, yardstick)
        found[f"orders_{title}_stretch"] = orders("needed", names, yardstick="stretch")
    certain = []
    for name in SAMPLED:
        for yardstick in ("needed", "stretch"):
            both = [orders("needed", names, name, yardstick) for names in ((Q,), (PRQ, PRQ_SCALED))]
            certain.append(all(interval_or_value(number)[0] >= ORDERS for number in both))
    found["grid_orders"] = share_of(certain)
    for name in REUSERS:
        found[f"reached_stretch_{name}"] = mean_over_layouts(
            "tasks", lambda t, n=name: t["stretch"][n] is not None
        )
        found[f"regret_{name}"] = mean_over_layouts("tasks", lambda t, n=name: t["regret"][n])
        needed = [task["needed"][name] or settings["episodes"] for cell in results for task in cell["tasks"]]
        found[f"median_needed_{name}"] = exact_value(float(np.median(needed)), len(needed))
    found["orders_prq_as_returned"] = orders("needed", [PRQ])
    found["library_return"] = mean_over_layouts("tasks", itemgetter("best"))
    spent = len(STRATEGIES) * settings["training_episodes"] + len(STRATEGIES) ** 2 * settings["samples"]
    found["training_episodes"] = exact_value(spent, len(results))
    moved = {f"moved_{name}": mean_over_layouts("moved", itemgetter(name)) for name in ("best", BPR, *LEARNERS)}
    return found | moved


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a layout, with its library; a row a task; then curves, mean and standard deviation over tasks."""
    found: list[dict] = [{key: cell[key] for key in ("layout", "foods", "mean", "deviation")} for cell in results]
    for cell in results:
        for task, moved in zip(cell["tasks"], cell["moved"], strict=True):
            row = {key: task[key] for key in ("type", "best", "needed", "stretch", "regret", "greedy")}
            found.append({"task_of": cell["layout"], **row, "moved": moved})
    found.append({"curve_edges": block_edges(settings["episodes"]).tolist()})
    for name in (BPR, PRQ, Q):
        curves = np.array([task["curves"][name] for cell in results for task in cell["tasks"]])
        mean, deviation = curves.mean(axis=0), curves.std(axis=0, ddof=1)
        found.append({"curve_of": name, "mean": mean.round(1).tolist(), "deviation": deviation.round(1).tolist()})
    return found
