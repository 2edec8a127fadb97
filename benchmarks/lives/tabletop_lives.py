"""`bench tabletop_lives`: long lives of tabletop jobs, the whole agent beside the agent without each of its parts.

A life is forty jobs and then forty on trays that it has not met. Lives of a round share their trays, in another
order, and draw their own users, grippers and contexts; equal actions on a tray are simulated once. Every agent
lives each life from the start, so that all differences are paired. The best possible return is found by search in
the simulator; it knows the true scene and the hidden type. The informed agent knows true relations and the type.
"""

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from benchmarks.lives.informed_agent import informed_returns
from benchmarks.rounds import at_least, at_most, estimated_row
from lifelore.agent.long_lived.families.by_name import TABLETOP_TYPES
from lifelore.agent.long_lived.families.tabletop import TabletopFamily
from lifelore.agent.long_lived.families.tray_states import N_SITUATED, SPILLS
from lifelore.agent.long_lived.knowledge import Knowledge
from lifelore.agent.long_lived.live_task import LivingSettings, live_task
from lifelore.agent.long_lived.task_family import AGENTS, Abilities
from lifelore.agent.long_lived.task_log import TaskLog
from lifelore.core.metrics import mean_estimate
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.tabletop_job.best_return import OutcomeTree
from lifelore.domains.task_stream import TaskStream
from reproduction.engine.cell_store import CellStore
from reproduction.engine.source_key import source_key

Array = NDArray[np.float64]

LIVES = 5
"""Lives of a round: they share the trays, so that the first takes longest, some 15 minutes of a core."""
N_TASKS = 40
"""Tasks of the first part of a life, and of the second on new trays."""
RAW = "full, raw clouds"
LIVING_AGENTS = AGENTS | {RAW: AGENTS["full"]}
"""The agent and its ablations see points with labels; one sees raw clouds."""
INFORMED = "informed"
"""A yardstick, see `informed_agent`; no bound, because it has seen rare types in a few tasks alone."""
MET = 3
"""Earlier tasks of a type from which an alarm in its tasks counts as false."""
LIVING = LivingSettings(n_episodes=5)
OUT = Path("benchmarks/results")


@dataclass(frozen=True)
class LifeResult:
    """What an agent reached in one life, task by task.

    first, last, best : (n_tasks,) returns of the first and last episode, and the best possible
    spills : (n_tasks,) spilling acts of the first episode
    alarms : (n_tasks,) whether no known type fitted
    met : (n_tasks,) in how many earlier tasks of the life the type was met
    n_types : number of types that are known at the end, alike ones joined
    """

    first: Array
    last: Array
    best: Array
    spills: Array
    alarms: Array
    met: Array
    n_types: int

    def to_dict(self) -> dict[str, Any]:
        """As JSON data."""
        return {name: np.round(value, 6).tolist() for name, value in vars(self).items()}

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any]) -> Self:
        """From `to_dict`."""
        arrays = {name: np.array(value) for name, value in plain.items() if name != "n_types"}
        return cls(**arrays, n_types=plain["n_types"])

    def share(self, part: slice, episode: str = "first") -> float:
        """Share of the best possible return over some tasks."""
        return float(getattr(self, episode)[part].sum() / self.best[part].sum())

    @property
    def false_alarms(self) -> float:
        """Share of the tasks on new trays with an alarm, of those whose type was met before."""
        known = self.met[NEW] >= MET
        return float(self.alarms[NEW][known].mean()) if known.any() else 0.0


NEW, LATE = slice(N_TASKS, None), slice(-20, None)
"""The tasks on new trays, and the last twenty of them."""


def lived_round(
    seed: int, n_tasks: int = N_TASKS, lives: int = LIVES, store: CellStore | None = None
) -> list[dict[str, LifeResult]]:
    """The lives of a round, each by agent; they share trays, and so the outcomes of equal actions on them.

    A finished life is kept in the store, and a round that was stopped goes on with the next.
    """
    trees: dict[tuple[int, str], OutcomeTree] = {}
    found = []
    for number in range(lives):
        cell = {"round": seed, "life": number}
        kept = store.get(cell) if store else None
        if kept is None:
            began = time.perf_counter()
            life = _life(seed, number, n_tasks, trees)
            if store:
                plain = {agent: one.to_dict() for agent, one in life.items()}
                store.put(cell, plain, round(time.perf_counter() - began, 1))
        else:
            life = {agent: LifeResult.from_dict(one) for agent, one in kept["result"].items()}
        found.append(life)
    return found


def _life(
    seed: int, number: int, n_tasks: int, trees: dict[tuple[int, str], OutcomeTree]
) -> dict[str, LifeResult]:
    rng = stream(seed, "tabletop lives", "trays", number)
    trays = [*rng.permutation(n_tasks).tolist(), *(n_tasks + rng.permutation(n_tasks)).tolist()]
    types = TaskStream(TABLETOP_TYPES, seed=1000 * seed + number)
    families = {raw: TabletopFamily(types, seed, not raw, trees, tuple(trays)) for raw in (False, True)}
    lived = {
        name: _lived(families[name == RAW], agent, 2 * n_tasks, seed) for name, agent in LIVING_AGENTS.items()
    }
    informed = informed_returns(families[False], 2 * n_tasks, LIVING.n_episodes, seed)
    # After all agents have lived: what one of them found is possible for all.
    best = np.array([families[False].best_return(task) for task in range(2 * n_tasks)])
    found = {name: _result(tasks, best, n_types) for name, (tasks, n_types) in lived.items()}
    met, none = found["full"].met, np.zeros(2 * n_tasks)
    found[INFORMED] = LifeResult(informed, informed, best, none, none, met, len(TABLETOP_TYPES))
    return found


def _lived(family: TabletopFamily, abilities: Abilities, n_tasks: int, seed: int) -> tuple[list[TaskLog], int]:
    """The tasks of a life, and the number of types that are known at its end."""
    knowledge = Knowledge.empty(family)
    tasks: list[TaskLog] = []
    for number in range(n_tasks):
        if not abilities.memory:
            knowledge = Knowledge.empty(family)
        drawn, task = family.meet(number, abilities)
        lived, _ = live_task(knowledge, drawn, task, abilities, LIVING, f"robot.{number}", seed)
        tasks.append(lived)
    return tasks, len(knowledge.known_types())


def _result(tasks: list[TaskLog], best: Array, n_types: int) -> LifeResult:
    types = [task.drawn.hidden_type for task in tasks]
    return LifeResult(
        np.array([task.returns[0] for task in tasks]),
        np.array([task.returns[-1] for task in tasks]),
        best,
        np.array([n_spills(task) for task in tasks], np.float64),
        np.array([task.alarm for task in tasks], np.float64),
        np.array([types[:number].count(one) for number, one in enumerate(types)], np.float64),
        n_types,
    )


def n_spills(task: TaskLog) -> int:
    """Acts of the first episode that spilled an object."""
    effects = [effect for decision in task.decisions[0] for effect in decision.effects]
    return sum(cause < N_SITUATED and effect in SPILLS for cause, effect in effects)


def bench_tabletop_lives(repeats: int, progress: Progress, out: Path = OUT) -> dict[str, Any]:
    """Rows and goals; see `benchmarks.bench`. A round is five lives on eighty trays of its own.

    Two rounds or more are lived by two processes, and drawn as ``bench_tabletop_lives.png`` in `out`. A bench that
    was stopped goes on with the life that it was in.
    """
    from joblib import Parallel, delayed

    store = CellStore(out / "cells" / "tabletop_lives", {"code": source_key(__name__)})
    done: list[list[dict[str, LifeResult]]] = []
    progress(0, repeats, "rounds")
    work = (delayed(lived_round)(seed, store=store) for seed in range(repeats))
    rounds = cast(Iterable[Any], Parallel(n_jobs=min(2, repeats), return_as="generator")(work))
    for lives in rounds:
        done.append(lives)
        progress(len(done), repeats, "rounds")
    if repeats > 1:
        _draw([life for lives in done for life in lives], out)
    return report(done)


def report(rounds: Sequence[Sequence[Mapping[str, LifeResult]]]) -> dict[str, Any]:
    """Rows and goals of rounds with equally many lives; intervals are over rounds, whose lives share trays."""
    lives = [life for one in rounds for life in one]
    shares = {agent: np.array([life[agent].share(NEW) for life in lives]) for agent in LIVING_AGENTS}
    spills = {agent: np.array([life[agent].spills[NEW].mean() for life in lives]) for agent in LIVING_AGENTS}
    rows = []

    def add(name: str, of_lives: ArrayLike, unit: str) -> None:
        estimate = mean_estimate(np.reshape(of_lives, (len(rounds), -1)).mean(axis=1))
        rows.append(estimated_row(name, replace(estimate, n=len(lives)), unit))

    for agent in LIVING_AGENTS:
        early = [life[agent].share(slice(0, N_TASKS)) for life in lives]
        last = [life[agent].share(NEW, "last") for life in lives]
        add(f"{agent}: first episodes of the first forty tasks", early, "of the best")
        add(f"{agent}: first episodes on new trays", shares[agent], "of the best")
        add(f"{agent}: last episodes on new trays", last, "of the best")
        add(f"{agent}: spills in first episodes on new trays", spills[agent], "a task")
        if agent != "full":
            less = shares["full"] - shares[agent]
            add(f"full less {agent}: first episodes on new trays", less, "of the best")
            late = [life["full"].share(LATE) - life[agent].share(LATE) for life in lives]
            add(f"full less {agent}: first episodes of the last twenty tasks", late, "of the best")
    add("full: types known at the end", [life["full"].n_types for life in lives], "types")
    add("full: alarms on new trays", [life["full"].alarms[NEW].mean() for life in lives], "a task")
    false = [life["full"].false_alarms for life in lives]
    add("full: false alarms on new trays", false, "a task of a type that was met thrice")
    informed = np.array([life[INFORMED].share(NEW) for life in lives])
    add(f"{INFORMED}: first episodes on new trays", informed, "of the best")
    of_informed = shares["full"] / informed
    add("full: first episodes on new trays, of the informed agent's", of_informed, "of its")
    scratch = float(spills["scratch"].mean())
    goals = [
        at_least("full: first episodes on new trays", 0.95, float(shares["full"].mean())),
        at_most("full: spills, of those of scratch", 0.05, float(spills["full"].mean()) / max(scratch, 1e-9)),
    ]
    return {"rows": rows, "goals": goals}


def curve(
    lives: Iterable[Mapping[str, LifeResult]], agent: str, width: int = 10
) -> tuple[NDArray[np.int64], Array]:
    """Task numbers and share of the best possible return, over `width` tasks up to each, of all lives together."""
    first = np.sum([life[agent].first for life in lives], axis=0)
    best = np.sum([life[agent].best for life in lives], axis=0)
    window = np.ones(width)
    return np.arange(width, len(first) + 1), np.convolve(first, window, "valid") / np.convolve(
        best, window, "valid"
    )


def _draw(lives: Sequence[Mapping[str, LifeResult]], out: Path) -> None:
    from benchmarks.lives.figure_life_curves import draw_life_curves
    from lifelore.figures.style import save_figure

    out.mkdir(parents=True, exist_ok=True)
    curves = {agent: curve(lives, agent) for agent in LIVING_AGENTS}
    save_figure(draw_life_curves(curves, N_TASKS, len(lives)), out / "bench_tabletop_lives.png")
