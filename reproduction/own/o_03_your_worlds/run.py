"""O3: lives in worlds of others, at the default of `live_in`, against a textbook learner and one without past.

``lore``, ``scratch`` and ``textbook`` are the three agents of `live_in` and meet the same tasks and episodes. The
second half of the tasks of each life is compared. The default was chosen on lives 0 to 9; these are others.
"""

import warnings
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.any_tasks.live_in import AGENTS, live_in
from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate
from reproduction.engine.estimates import exact_value
from reproduction.own.o_03_your_worlds.worlds import WORLDS

MEASURES = {"first": "first_return", "all": "mean_return", "last": "final_return"}
"""First episode, all episodes, last tenth of the episodes of a task."""
FIRST_LIFE = 20
"""Number of the first life; smaller numbers chose the default of `live_in`."""


def cells(settings: Mapping) -> list[dict]:
    """A life in a world each."""
    return [
        {"world": world, "life": life} for world, life in product(settings["worlds"], range(settings["lives"]))
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean discounted returns of the second half of the tasks, by agent."""
    world, tasks = WORLDS[cell["world"]], settings["tasks"]
    life = FIRST_LIFE + 100 * seed + cell["life"]
    size: dict[str, Any] = {"tasks": tasks, "episodes": world.episodes, "max_steps": world.max_steps}
    size |= world.different
    with world.make(life) as own, warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # a life of a world that teaches nothing is a result too
        late = live_in(own, seed=life, **size)["tasks"][tasks // 2 :]
    found = {
        f"{key}_{who}": float(np.mean([task["agents"][who][name] for task in late]))
        for (key, name), who in product(MEASURES.items(), AGENTS)
    }
    return {**cell, **found}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Returns and gains over lives in the first world, and the number of worlds below the textbook."""
    worlds = settings["worlds"]
    below = {
        f"below_{key}": exact_value(sum(_certainly_below(results, world, key) for world in worlds), len(worlds))
        for key in ("all", "last")
    }
    return numbers(results, worlds[0]) | below


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The same for every world."""
    for world in settings["worlds"]:
        yield {"world": world}, numbers(results, world)


def numbers(results: Sequence[Mapping], world: str) -> dict[str, Estimate]:
    """Mean returns and paired gains over the lives in a world."""
    means = {f"{key}_{who}": mean_estimate(_values(results, world, f"{key}_{who}")) for key, who in _EACH}
    return means | {f"{key}_over_{who}": _gain(results, world, key, who) for key, who in _EACH if who != "lore"}


_EACH = list(product(MEASURES, AGENTS))


def _values(results: Sequence[Mapping], world: str, name: str) -> NDArray[np.float64]:
    return np.array([result[name] for result in results if result["world"] == world])


def _gain(results: Sequence[Mapping], world: str, key: str, over: str) -> Estimate:
    return difference_estimate(*(_values(results, world, f"{key}_{who}") for who in ("lore", over)))


def _certainly_below(results: Sequence[Mapping], world: str, key: str) -> bool:
    """Whether the whole 95 % interval of the gain over the textbook lies below 0."""
    interval = _gain(results, world, key, "textbook").ci95
    return interval is not None and interval[1] < 0


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Returns of each life, by world and agent: the table of docs/start/learning.md is made of them."""
    return [dict(result) for result in results]
