"""C4.4: policy reuse, PRQ and Q-learning on Pacman. Thesis: §4.6.3, Figure 4.8.

A task is a layout of foods and a ghost's strategy, which no method knows. Policy reuse and PRQ are given a policy
for each ghost, policy reuse also the returns of each policy against each ghost, Q-learning nothing.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.pacman.pacman import STRATEGIES, PacmanMaze
from lifelore.figures.style import Axes
from lifelore.interaction.baselines.probabilistic_policy_reuse import ProbabilisticPolicyReuse
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection import BeliefSampling
from reproduction.chapter4.c4_04_pacman import pacman_library
from reproduction.chapter4.c4_04_pacman.pacman_library import GREATEST, Arena, falling_schedule
from reproduction.chapter4.reuse.looks import look_of
from reproduction.chapter4.reuse.many_tasks import play_rule
from reproduction.engine.records import in_blocks
from reproduction.figures.curves import draw_curves
from reproduction.figures.panels import panels

Array = NDArray[np.float64]
RETURNS, LASTING = "a hundred returns", "every policy from then on"
"""What convergence is: the mean of a hundred returns is good, or BPR's every expected return."""
UNITS = {"PRQ in [0, 1]": GREATEST, "PRQ as paid": 1.0}
"""Unit of the returns that PRQ's temperature multiplies: Fernandez and Veloso's lie in [0, 1] (E61)."""
Q = "Q-learning"
LEAST_DEVIATION = 1e-3 * 240
"""Least deviation of exact models: a thousandth of the range of returns, as with learnt models."""
DRAWN = 5
"""Layouts of Figure 4.8: twenty tasks with four ghosts each."""


def check(settings: Mapping) -> None:
    """Refuse a maze that cannot be a figure eight."""
    PacmanMaze(settings["rows"], settings["columns"])


def cells(settings: Mapping) -> list[dict]:
    """The layouts of foods."""
    return [{"layout": layout} for layout in range(settings["layouts"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One layout's four tasks: episodes until each method has converged, and returns in blocks of episodes.

    ``reuse``: by kind of models and meaning of convergence; ``learners``: by learner; None where it never has.
    """
    maze, here = PacmanMaze(settings["rows"], settings["columns"]), (seed, "pacman", cell["layout"])
    arenas = pacman_library.arenas(maze, maze.draw_foods(stream(*here, "foods")))
    policies = pacman_library.trained_policies(settings, arenas, here)
    moments = pacman_library.exact_moments(arenas, policies)
    target = moments[0].max(axis=1) - settings["tolerance"] * GREATEST
    window = min(settings["window"], settings["reuse_episodes"], settings["episodes"])
    drawn = np.array([
        arena.returns_of_each(policies, settings["episodes"], (*here, "task", arena.task.strategy, "reuse"))
        for arena in arenas
    ])  # fmt: skip
    tasks: list[dict] = [
        {"reuse": {}, "learners": {}, "curves": {}, "best": best} for best in moments[0].max(axis=1)
    ]
    for number, (kind, library) in enumerate(libraries(settings, arenas, policies, moments, here).items()):
        returns = drawn if number == 0 else drawn[..., : settings["reuse_episodes"]]
        chosen = reused(library, returns, stream(*here, "reuse", kind))
        for task, found in enumerate(tasks):
            paid = returns[task, chosen[task], np.arange(returns.shape[-1])]
            good = moments[0][task, chosen[task]] >= target[task]
            found["reuse"][kind] = {
                RETURNS: first_stretch(paid, target[task], window),
                LASTING: first_stretch(good, 1.0, window),
            }
            if number == 0:
                found["curves"]["BPR"] = in_hundred(paid)
    for found, arena, goal in zip(tasks, arenas, target, strict=True):
        for name in (*UNITS, Q):
            returns = _learn(settings, name, arena, policies, (*here, "task", arena.task.strategy))
            found["learners"][name] = first_stretch(returns, goal, window)
            found["curves"][name] = in_hundred(returns)
    return {**cell, "tasks": tasks}


def libraries(
    settings: Mapping, arenas: Sequence[Arena], policies: Array, moments: tuple[Array, Array], here: tuple
) -> dict[str, PolicyLibrary]:
    """Models of returns by kind: learnt from each number of samples a pair, the default first, and exact ones."""
    names = (STRATEGIES, STRATEGIES)
    samples = pacman_library.sampled_returns(arenas, policies, max(settings["samples"]), (*here, "samples"))
    found = {f"{n} returns": PolicyLibrary.from_samples(samples[..., :n], *names) for n in settings["samples"]}
    return found | {"exact": PolicyLibrary.from_means(moments[0], np.maximum(moments[1], LEAST_DEVIATION), *names)}


def reused(library: PolicyLibrary, returns: Array, generator: np.random.Generator) -> NDArray[np.int64]:
    """The policies that belief sampling selects, (n_tasks, n_episodes), of `returns` (n_tasks, n_policies, …)."""
    every = np.arange(len(returns))
    return play_rule(
        BeliefSampling(), library, lambda episode, chosen: returns[every, chosen, episode],
        len(returns), returns.shape[-1], generator,
    ).policies  # fmt: skip


def first_stretch(returns: Array, target: float, window: int) -> int | None:
    """First episode, counted from 1, of a stretch of `window` whose mean return reaches the target."""
    # Summed before divided: a hundred returns of 140 have the mean 140.
    reached = np.flatnonzero(np.convolve(returns, np.ones(window), mode="valid") / window >= target)
    return int(reached[0]) + 1 if reached.size else None


def in_hundred(returns: Array) -> list[float]:
    """Mean returns of even blocks of episodes."""
    return in_blocks(returns[None])[0].round(1).tolist()


def _learn(settings: Mapping, name: str, arena: Arena, policies: Array, stream_of: tuple) -> Array:
    """A learner's returns by episode."""
    plan = falling_schedule(settings["epsilon"], settings["rate"], settings["episodes"], 1.0)
    if name == Q:
        return arena.learn(arena.begin(stream_of), plan).rewards
    prq = ProbabilisticPolicyReuse(gain_unit=UNITS[name])
    world, own = stream(*stream_of, "world"), stream(*stream_of, "learner")
    reuser = prq.begin(arena.task.n_observations, policies, world, own)
    return prq.learn(arena.tables, arena.rows, policies, plan, reuser)[0].rewards


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """Each kind of models, meaning of convergence and unit of PRQ's returns; intervals are over layouts."""
    every = settings["episodes"]

    def orders(kind: str, meaning: str, learner: str) -> Estimate:
        # All episodes where they were not enough.
        def power(task: Mapping) -> float:
            return np.log10((task["learners"][learner] or every) / (task["reuse"][kind][meaning] or every))

        return mean_estimate([np.mean([power(task) for task in result["tasks"]]) for result in results])

    for kind, meaning, prq in product(results[0]["tasks"][0]["reuse"], (RETURNS, LASTING), UNITS):
        yield (
            {"models": kind, "converged": meaning, "temperature": prq},
            {
                "orders_q": orders(kind, meaning, Q),
                "orders_prq": orders(kind, meaning, prq),
            },
        )


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Curves of twenty tasks, by block of episodes, and the library's best."""
    tasks = [task for result in results[:DRAWN] for task in result["tasks"]]
    found = []
    for name, label in (("BPR", "BPR"), (next(iter(UNITS)), "PRQ"), (Q, Q)):
        curves = np.array([task["curves"][name] for task in tasks])
        mean, deviation = (of.round(1).tolist() for of in (curves.mean(axis=0), curves.std(axis=0)))
        found.append({"method": label, "tasks": len(tasks), "mean": mean, "deviation": deviation})
    return [*found, {"best": round(float(np.mean([task["best"] for task in tasks])), 2)}]


@panels(7.2, 3.9)
def draw(result: Mapping, axes: Axes) -> None:
    """Returns of policy reuse, PRQ and Q-learning by episode (Figure 4.8).

    Means of twenty tasks, one standard deviation shaded.
    """
    (*curves, level), episodes = result["rows"], result["settings"]["episodes"]
    points = len(curves[0]["mean"])
    draw_curves(
        axes, (np.arange(points) + 0.5) * episodes / points, {row["method"]: row for row in curves},
        looks={row["method"]: look_of(row["method"]) for row in curves}, xlabel="episode", ylabel="return",
        title=f"Pacman, {curves[0]['tasks']} tasks", level=(level["best"], "library's best"), legend=False,
    )  # fmt: skip
    axes.set_xlim(0, episodes)
    axes.figure.legend(loc="outside right upper")
