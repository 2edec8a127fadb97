"""Time of the main job: a life's tasks in a generated office, by agent, beside Q-learning in plain Python.

A life is `live` in this process: agents explore, plan and evaluate their policies, and each task is stored in a
memory file. Seconds are those of the processor, so that other programs count little; a row of its own has the wall
time of the longest life, with its waits for the disk and for other programs. The ratio of `lore` to `scratch`
compares time alone: `lore` needs fewer steps. The plain Python loop makes as many steps as learner q in its life,
on tables of the same world; it neither evaluates nor stores anything.
"""

import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from benchmarks.peers.list_loop import tuned_rate
from benchmarks.rounds import at_most, counted, interleaved, row, row_beside
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.agent.live.task_result import TaskResult
from lifelore.core.protocols import Progress
from lifelore.domains.worlds import make_world

TASKS, Q_TASKS = 30, 3
"""Tasks of a life, and of one with learner q, whose tasks take a second each."""
MOST_SECONDS = 90.0
"""Most seconds by the clock of a life of `TASKS` tasks with every agent."""
SCRATCH, LORE = "a task of scratch", "a task of lore, which remembers"
Q, PLAIN = "a task of scratch, learner q", "as many steps of Q-learning in tuned pure Python"
EVERY = f"a life of {TASKS} tasks with every agent"


def bench_lives(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    steps: list[int] = []
    walls: list[float] = []

    def every() -> float:
        began = time.perf_counter()
        seconds = life_seconds("all", TASKS)
        walls.append(time.perf_counter() - began)
        return seconds

    contenders: dict[str, Callable[[], float]] = {
        SCRATCH: lambda: life_seconds("scratch", TASKS) / TASKS,
        LORE: lambda: life_seconds("lore", TASKS) / TASKS,
        EVERY: every,
        Q: lambda: life_seconds("scratch", Q_TASKS, "q", steps) / Q_TASKS,
        PLAIN: lambda: plain_seconds(sum(steps) / len(steps)),
    }
    life_seconds("all", 1)  # compiled before anything is timed
    life_seconds("scratch", 1, "q")
    times = interleaved(contenders, repeats, counted(progress, repeats * len(contenders)))
    return {
        "rows": [
            row_beside(SCRATCH, times, "s"),
            row_beside(LORE, times, "s", SCRATCH),
            row_beside(EVERY, times, "s"),
            row(f"{EVERY}: wall time", median(walls), "s"),
            row(f"steps of {Q}", sum(steps) / len(steps), "steps"),
            row_beside(Q, times, "s"),
            row_beside(PLAIN, times, "s", Q),
        ],
        "goals": [at_most(f"{EVERY}: wall time, s", MOST_SECONDS, median(walls))],
    }


def life_seconds(agent: str, tasks: int, learner: str = "model", steps: list[int] | None = None) -> float:
    """Processor seconds of a life with a new memory; the steps of `scratch` in each task are added to `steps`."""
    with TemporaryDirectory() as folder:
        settings = LifeSettings(
            learner=learner,
            memory=MemorySettings(str(Path(folder) / "life.db")),
            agent=agent,
            compare=False,
            tasks=tasks,
            jobs=1,
        )
        started = time.process_time()
        life = live(settings)
        seconds = time.process_time() - started
    if steps is not None:
        alone = [results["scratch"] for results in life.results]
        steps += [int(one.curve.steps.sum()) for one in alone if isinstance(one, TaskResult)]
    return seconds


def plain_seconds(steps: float) -> float:
    """Processor seconds of so many steps of the tuned loop, at its rate on a task of the same office."""
    tables = make_world("building").task(0).tables()
    return steps / (1e6 * tuned_rate(tables=tables, clock=time.process_time))
