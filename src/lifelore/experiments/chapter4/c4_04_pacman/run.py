"""C4.4: on Pacman, Bayesian policy reuse converges orders of magnitude sooner than PRQ and than Q-learning.

What each is given: BPR and PRQ four policies trained beforehand for the task's own foods, one a ghost; BPR also
how each returned against each ghost; Q-learning nothing. Training is counted in `training_episodes`. Tasks of one
layout share a library: intervals are over layouts. Thesis: §4.6.3, Figure 4.8.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.pacman.pacman import STRATEGIES, PacmanMaze
from lifelore.experiments.chapter4.c4_04_pacman.pacman_library import GREATEST
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
    run_cell,
)
from lifelore.experiments.engine.claim import Claim
from lifelore.experiments.engine.curve_blocks import block_edges
from lifelore.experiments.engine.predicate import Predicate

FULL = {
    "layouts": 20,
    "rows": 7,
    "columns": 7,
    "episodes": 10_000,
    "rate": 0.5,
    "epsilon": 0.5,
    "window": 100,
    "tolerance": 0.05,
    "checkpoints": [10, 30, 100, 200, 300, 500, 1000, 2000, 3000, 5000, 7000],
    "peer_episodes": 1000,
    "samples": 10,
    "more_samples": 100,
    "training_episodes": 100_000,
    "training_discount": 0.97,
    "training_rate": 0.5,
    "training_epsilon": 0.5,
}
QUICK = {
    **FULL,
    "layouts": 3,
    "rows": 5,
    "columns": 5,
    "episodes": 1000,
    "checkpoints": [30, 100, 300],
    "peer_episodes": 200,
    "training_episodes": 20_000,
}
REUSERS = (BPR, BPR_EI, BPR_MORE, BPR_EXACT)
CAUSES = {
    "BPR converges": "ten samples of returns that are won or lost tell close policies apart poorly",
    "over Q-learning": "where ten samples overestimate a policy BPR may keep to it for good, which counts as all "
    "10,000 episodes; with a hundred samples a pair the power is above 3",
    "over PRQ": "the same, and PRQ too is a bandit over the library, which sometimes has the right policy after "
    "tens of episodes; with a hundred samples a pair the power is above 2",
    "over greedy Q-learning": "at ε = 0.5 a policy is good long before its episodes are",
    "over greedy PRQ": "episodes of a good policy show PRQ what to learn, and its greedy policy soon copies it",
}


def _cells(settings: Mapping) -> list[dict]:
    return [{"layout": layout} for layout in range(settings["layouts"])]


def _check(settings: Mapping) -> None:
    for key in ("layouts", "episodes", "window", "peer_episodes", "samples", "training_episodes"):
        if settings[key] < 1:
            raise InputError(f"{key} must be at least 1, got {settings[key]}")
    if not settings["window"] <= settings["peer_episodes"] <= settings["episodes"]:
        raise InputError(
            f"peer_episodes must lie between window ({settings['window']}) and episodes "
            f"({settings['episodes']}), got {settings['peer_episodes']}"
        )
    if settings["more_samples"] < settings["samples"]:
        raise InputError(f"more_samples must be at least samples, got {settings['more_samples']}")
    for key in ("rate", "epsilon", "tolerance", "training_discount", "training_rate", "training_epsilon"):
        if not 0 <= settings[key] <= 1:
            raise InputError(f"{key} must lie in [0, 1], got {settings[key]}")
    looks = [0, *settings["checkpoints"], settings["episodes"]]
    if any(not isinstance(look, int) for look in looks) or (np.diff(looks) < 1).any():
        raise InputError(f"checkpoints must rise between 0 and episodes, got {settings['checkpoints']}")
    PacmanMaze(settings["rows"], settings["columns"])


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


def _draw(result: Mapping):
    from lifelore.experiments.chapter4.c4_04_pacman.figure_pacman_reuse import draw_pacman_reuse

    return draw_pacman_reuse(result, greatest=GREATEST)


CLAIM = Claim(
    id="C4.4",
    title="Policy reuse on Pacman (Figure 4.8)",
    thesis="BPR, being a bandit-style algorithm equipped with pre-trained policies, converges orders of magnitude "
    "faster than learning from scratch (Q-learning), even when that learning is seeded by policy transfer (PRQ) "
    "(twenty random tasks, 10,000 episodes of at most 200 steps).",
    sizes={"quick": QUICK, "full": FULL},
    predicate=Predicate.of("C4.4"),
    cells=_cells,
    run_cell=run_cell,
    measure=measure,
    rows=rows,
    draw=_draw,
    causes=CAUSES,
    check=_check,
)
