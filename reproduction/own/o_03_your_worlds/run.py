"""O3: lives in worlds of others, with an action prior and without one, under two schedules of ε.

``lore`` and ``scratch`` are the two agents of `live_in` and meet the same tasks and episodes. The second half of
the tasks of each life is compared.
"""

import warnings
from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.external_world.live_in import live_in
from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate
from reproduction.own.o_03_your_worlds.worlds import WORLDS

FALLING, CONSTANT = "1, falling", "0.1"
EPSILONS = {FALLING: {}, CONSTANT: {"epsilon": 0.1, "epsilon_decay": 1.0, "epsilon_floor": 0.1}}
"""Schedules of ε: the default of `live_in`, and the constant ε of textbooks."""
MEASURES = {"first": "first_return", "all": "mean_return"}
AGENTS = ("lore", "scratch")


def cells(settings: Mapping) -> list[dict]:
    """A life in a world under a schedule each."""
    every = product(settings["worlds"], EPSILONS, range(settings["lives"]))
    return [{"world": world, "epsilon": own, "life": life} for world, own, life in every]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean discounted returns of the second half of the tasks, by agent."""
    make, episodes, max_steps, own = WORLDS[cell["world"]]
    life, tasks = 100 * seed + cell["life"], settings["tasks"]
    own = {"tasks": tasks, "episodes": episodes, "max_steps": max_steps, **own, **EPSILONS[cell["epsilon"]]}
    with make(life) as world, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "The action prior is empty")  # then both agents are alike
        late = live_in(world, seed=life, **own)["tasks"][tasks // 2 :]
    found = {
        f"{key}_{who}": float(np.mean([task["agents"][who][name] for task in late]))
        for (key, name), who in product(MEASURES.items(), AGENTS)
    }
    return {**cell, **found}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Returns and gains over lives in the first world, ε falling."""
    return numbers(results, settings["worlds"][0], FALLING)


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The same for every world and schedule."""
    for world, epsilon in product(settings["worlds"], EPSILONS):
        yield {"world": world, "ε": epsilon}, numbers(results, world, epsilon)


def numbers(results: Sequence[Mapping], world: str, epsilon: str) -> dict[str, Estimate]:
    """Mean returns and paired gains over the lives in a world."""

    def values(name: str, schedule: str = epsilon) -> NDArray[np.float64]:
        return np.array([one[name] for one in results if (one["world"], one["epsilon"]) == (world, schedule)])

    return {
        "all_lore": mean_estimate(values("all_lore")),
        "all_scratch": mean_estimate(values("all_scratch")),
        "all_gain": difference_estimate(values("all_lore"), values("all_scratch")),
        "first_gain": difference_estimate(values("first_lore"), values("first_scratch")),
        "all_gain_over_constant": difference_estimate(values("all_lore"), values("all_scratch", CONSTANT)),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean return over all episodes of each life, by world, agent and schedule."""
    names = ("world", "epsilon", "all_lore", "all_scratch")
    return [{name: result[name] for name in names} for result in results]
