"""Time of the main job: a life's tasks in a generated office, by agent.

A life is `live` in this process: agents explore, plan and evaluate their policies, and each task is stored in a
memory file. Seconds are those of the processor, so that other programs count little; a row of its own has the wall
time of the longest life, with its waits for the disk and for other programs. The ratio of `lore` to `scratch`
compares time alone: `lore` needs fewer steps.
"""

import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from benchmarks.rounds import at_most, counted, interleaved, row, row_beside
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.core.protocols import Progress

TASKS = 30
"""Tasks of a life."""
MOST_SECONDS = 90.0
"""Most seconds by the clock of a life of `TASKS` tasks with every agent."""
SCRATCH, LORE = "a task of scratch", "a task of lore, which remembers"
EVERY = f"a life of {TASKS} tasks with every agent"


def bench_lives(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
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
    }
    life_seconds("all", 1)  # compiled before anything is timed
    times = interleaved(contenders, repeats, counted(progress, repeats * len(contenders)))
    return {
        "rows": [
            row_beside(SCRATCH, times, "s"),
            row_beside(LORE, times, "s", SCRATCH),
            row_beside(EVERY, times, "s"),
            row(f"{EVERY}: wall time", median(walls), "s"),
        ],
        "goals": [at_most(f"{EVERY}: wall time, s", MOST_SECONDS, median(walls))],
    }


def life_seconds(agent: str, tasks: int) -> float:
    """Processor seconds of a life with a new memory."""
    with TemporaryDirectory() as folder:
        settings = LifeSettings(
            memory=MemorySettings(str(Path(folder) / "life.db")),
            agent=agent,
            compare=False,
            tasks=tasks,
            jobs=1,
        )
        started = time.process_time()
        live(settings)
        return time.process_time() - started
