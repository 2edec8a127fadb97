"""`bench worlds`: what lives gain in seven worlds of Gymnasium and MiniGrid, against two learners without a past.

``lore`` and ``scratch`` are those of `live_in`; ``textbook`` is twenty lines of Q-learning with ε = 0.1. All three
meet the same tasks and episodes. Compared are the tasks of the second half of each life. Nothing was tuned on the
results: where the prior does not help, the table says so.
"""

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.lives.foreign_worlds import WORLDS, ForeignWorld
from benchmarks.lives.textbook_q import textbook_q_returns
from benchmarks.rounds import at_least, row
from lifelore.agent.external_world.live_in import live_in
from lifelore.core.metrics import interquartile_mean_estimate, mean_estimate
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream

AGENTS = ("lore", "scratch", "textbook")
MEASURES = {"first_return": "first episode", "mean_return": "all episodes", "final_return": "last tenth"}
TASKS = 8
LEAST_LIVES = 5
_DEFAULTS = {"discount": 0.95, "learning_rate": 0.5}


def bench_worlds(
    repeats: int, progress: Progress, tasks: int = TASKS, worlds: Mapping[str, ForeignWorld] = WORLDS
) -> dict:
    """Rows and goals; see `benchmarks.bench`. `repeats` are lives in each world.

    Beside them ``worlds``: for each world and measure the mean of each agent, and the paired differences of lore
    to the others, as mean (over lives) and interquartile mean (over lives and tasks), with 95 % intervals.
    """
    found = {}
    for place, (name, world) in enumerate(worlds.items()):
        lives = []
        for run in range(repeats):
            lives.append(one_life(world, run, tasks))
            progress(place * repeats + run + 1, len(worlds) * repeats, f"{name}, life {run + 1}")
        found[name] = {"tasks": world.tasks, **compared(lives)}
    rows = [entry for name, world in found.items() for entry in _rows(name, world)]
    return {"rows": rows, "goals": [at_least("lives in each world", LEAST_LIVES, repeats)], "worlds": found}


def one_life(world: ForeignWorld, run: int, tasks: int) -> dict[str, Any]:
    """One life: measure to agent to the value of each task, and the number of contexts of the prior at the end."""
    settings = {**_DEFAULTS, **world.settings}
    with world.make(run) as lived, warnings.catch_warnings():
        # An empty prior shows in the table: no contexts.
        warnings.filterwarnings("ignore", "The action prior is empty")
        report = live_in(lived, tasks=tasks, seed=run, **settings)
        returns = [_textbook(lived, run, task, settings) for task in range(tasks)]
    agents: dict[str, dict[str, list[float]]] = {measure: {} for measure in MEASURES}
    for measure in MEASURES:
        for who in AGENTS[:2]:
            agents[measure][who] = [task["agents"][who][measure] for task in report["tasks"]]
    last = [values[-max(1, len(values) // 10) :] for values in returns]
    agents["first_return"]["textbook"] = [values[0] for values in returns]
    agents["mean_return"]["textbook"] = [float(np.mean(values)) for values in returns]
    agents["final_return"]["textbook"] = [float(np.mean(values)) for values in last]
    return {"agents": agents, "contexts": report["n_contexts"]}


def _textbook(world: Any, run: int, task: int, settings: Mapping[str, Any]) -> list[float]:
    # The seeds of the episodes are those that `live_in` draws.
    seeds = stream(run, "task", task, "world").integers(2**31, size=settings["episodes"]).tolist()
    own = stream(run, "bench", "worlds", "textbook", task)
    return textbook_q_returns(
        world, task, seeds, settings["max_steps"], settings["discount"], settings["learning_rate"], own
    )


def compared(lives: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Means of each agent, and differences of lore to the others, over the second half of the tasks."""
    measures = {}
    for measure in MEASURES:
        values = {who: _second_half([life["agents"][measure][who] for life in lives]) for who in AGENTS}
        measures[measure] = {
            "agents": {who: _estimates(of) for who, of in values.items()},
            "lore_minus": {who: _estimates(values["lore"] - values[who]) for who in AGENTS[1:]},
        }
    return {"contexts": float(np.mean([life["contexts"] for life in lives])), "measures": measures}


def _second_half(values: Sequence[Sequence[float]]) -> NDArray[np.float64]:
    """(lives, tasks) of the later half of the tasks, at least one."""
    array = np.asarray(values, float)
    return array[:, -max(1, array.shape[1] // 2) :]


def _estimates(values: NDArray[np.float64]) -> dict[str, dict]:
    """The mean over lives, and the interquartile mean over lives and tasks."""
    return {
        "mean": mean_estimate(values.mean(axis=1)).to_dict(),
        "interquartile_mean": interquartile_mean_estimate(values).to_dict(),
    }


def _rows(name: str, world: Mapping[str, Any]) -> list[dict]:
    rows = []
    for measure, words in MEASURES.items():
        for who in AGENTS:
            estimate = world["measures"][measure]["agents"][who]["mean"]
            rows.append(_row(f"{name}, {words}: {who}", estimate))
        for who in AGENTS[1:]:
            for kind, estimate in world["measures"][measure]["lore_minus"][who].items():
                rows.append(_row(f"{name}, {words}: lore minus {who}, {kind.replace('_', ' ')}", estimate))
    return rows


def _row(name: str, estimate: Mapping[str, Any]) -> dict:
    return row(name, estimate["value"], "return") | {"ci95": estimate["ci95"], "n": estimate["n"]}
