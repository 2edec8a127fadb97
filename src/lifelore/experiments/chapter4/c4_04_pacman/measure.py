"""Measures and rows of claim C4.4."""

from collections.abc import Mapping, Sequence

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

REUSERS = (BPR, BPR_EI, BPR_MORE, BPR_EXACT)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Episodes that each method needs, powers of ten between them, what was spent beforehand, and moved foods."""
    found = {}
    for name in (*REUSERS, *LEARNERS):
        found |= _needed(settings, results, "needed", name, name)
    for name in LEARNERS:
        found |= _needed(settings, results, "greedy", name, f"greedy_{name}")
    for kind, prefix in (("needed", ""), ("greedy", "greedy_")):
        for extra in ("", DISCOUNTED):
            for title, names in (("q", (Q,)), ("prq", (PRQ, PRQ_SCALED))):
                one_of = [name + extra for name in names]
                found[f"orders_{prefix}{title}{extra}"] = _orders(settings, results, kind, one_of)
    found["orders_prq_as_returned"] = _orders(settings, results, "needed", [PRQ])
    for title, names in (("q", [Q]), ("prq", [PRQ, PRQ_SCALED])):
        found[f"orders_{title}_more_samples"] = _orders(settings, results, "needed", names, BPR_MORE)
    found["library_return"] = mean_estimate(
        [np.mean([task["best"] for task in cell["tasks"]]) for cell in results]
    )
    spent = len(STRATEGIES) * settings["training_episodes"]
    found["training_episodes"] = _plain(spent + len(STRATEGIES) ** 2 * settings["samples"], len(results))
    return found | _moved(results)


def _needed(settings: Mapping, results: Sequence[Mapping], kind: str, name: str, key: str) -> dict[str, Estimate]:
    """The share of tasks in which a method comes there at all, and the median episode, never being the last."""
    reached = [np.mean([task[kind][name] is not None for task in cell["tasks"]]) for cell in results]
    episodes = np.concatenate([_episodes(settings, cell, kind, name) for cell in results])
    return {f"reached_{key}": mean_estimate(reached), f"median_{key}": _plain(np.median(episodes), len(episodes))}


def _episodes(settings: Mapping, cell: Mapping, kind: str, name: str) -> NDArray[np.float64]:
    """Episodes needed, by task; all of them where they were not enough."""
    return np.array([task[kind][name] or settings["episodes"] for task in cell["tasks"]], float)


def _orders(
    settings: Mapping, results: Sequence[Mapping], kind: str, names: Sequence[str], reuser: str = BPR
) -> Estimate:
    """Mean power of ten between the fastest of some learners on each task and a form of BPR; over layouts."""
    powers = []
    for cell in results:
        slow = np.min([_episodes(settings, cell, kind, name) for name in names], axis=0)
        powers.append(np.log10(slow / _episodes(settings, cell, "needed", reuser)).mean())
    return mean_estimate(powers)


def _moved(results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Returns where foods lie elsewhere than in training: best of the library, BPR, learners at the end."""
    return {
        f"moved_{name}": mean_estimate([np.mean([task[name] for task in cell["moved"]]) for cell in results])
        for name in ("best", BPR, *LEARNERS)
    }


def _plain(value: float, n: int) -> Estimate:
    return Estimate(float(value), float(value), None, n)


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
