"""Time of a task as buildings grow from 5,000 to 300,000 places, for `lore` and `scratch` together.

Each size is a life of `TASKS` tasks in a generated office, in a process of its own whose kernels are compiled. The
first task is the dearest: nothing is known yet, and memory stores all of the building. Reading the map, which a
life does once, is timed apart and taken off the first task.
"""

import tempfile
from collections.abc import Callable, Sequence
from itertools import pairwise
from statistics import median

from benchmarks.process import measured_inside
from benchmarks.rounds import at_most, counted, row
from lifelore.core.protocols import Progress

SIZES = ((47.0, 35.0, 0.5), (150.0, 150.0, 0.9), (150.0, 150.0, 0.45), (150.0, 150.0, 0.225))
"""Metres of width and height of the office, and of a cell's side."""
TASKS = 3
GOALS = {75_000: 2.0, 300_000: 15.0}
"""Most seconds of a task in the building nearest to so many places."""
MOST_MEMORY = 1000.0
"""Megabytes."""

_LIFE = """
import json, resource, sys, time
from pathlib import Path
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.domains.buildings.occupancy_map import write_occupancy_map
from lifelore.domains.buildings.office import RESOLUTION, office_map
from lifelore.domains.worlds import WorldSettings, make_world

width, height, cell, tasks, folder = *map(float, sys.argv[1:4]), int(sys.argv[4]), Path(sys.argv[5])
live(LifeSettings(memory=MemorySettings(str(folder / "warm.db")), tasks=1))
office = office_map(0, width, height)
write_occupancy_map(folder / "office.yaml", office.grey, RESOLUTION, (0.0, 0.0, 0.0))
began = time.perf_counter()
make_world("building", map=str(folder / "office.yaml"), cell=cell)
reading, times = time.perf_counter() - began, []
world = WorldSettings(map=str(folder / "office.yaml"), cell=cell)
settings = LifeSettings(world, memory=MemorySettings(str(folder / "life.db")), tasks=tasks)
began = time.perf_counter()
report = live(settings, progress=lambda *_: times.append(time.perf_counter() - began)).report
print(json.dumps({
    "places": report["n_states"],
    "reading": reading,
    "seconds": times,
    "steps": [task["agents"]["scratch"]["steps_to_80"] for task in report["tasks"]],
    "megabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    "stored": (folder / "life.db").stat().st_size / 1e6,
}))
"""


def bench_buildings(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    after = counted(progress, len(SIZES) * repeats)
    lives = [_lives(size, repeats, after) for size in SIZES]
    rows = []
    for life in lives:
        name = f"{life['places']:,} places"
        first, later = f"first task, {name}", f"later task, {name}"
        rows += [
            row(f"reading the map, {name}", life["reading"], "s"),
            row(first, life["first"], "s"),
            row(later, life["later"], "s", first, life["later"] / life["first"]),
            row(f"steps of scratch in a task, {name}", life["steps"], "steps"),
            row(f"memory of the process, {name}", life["megabytes"], "MB"),
            row(f"memory file, {name}", life["stored"], "MB"),
        ]
    goals = []
    for places, seconds in GOALS.items():
        life = min(lives, key=lambda life: abs(life["places"] - places))
        slowest = max(life["first"], life["later"])
        goals.append(at_most(f"a task at {life['places']:,} places, s", seconds, slowest))
    goals.append(at_most("memory of the process, MB", MOST_MEMORY, max(life["megabytes"] for life in lives)))
    return {"rows": rows, "goals": goals}


def _lives(size: Sequence[float], repeats: int, after: Callable[[str], None]) -> dict[str, float]:
    """Medians over repeated lives in one building."""
    lives = []
    for _ in range(repeats):
        lives.append(life_in(size))
        after(f"{lives[-1]['places']:,} places")
    ends = [[life["reading"], *life["seconds"]] for life in lives]
    tasks = [[after - before for before, after in pairwise(end)] for end in ends]
    return {
        "places": lives[0]["places"],
        "reading": median(life["reading"] for life in lives),
        "first": median(task[0] for task in tasks),
        "later": median(seconds for task in tasks for seconds in task[1:]),
        "steps": median(step for life in lives for step in life["steps"]),
        "megabytes": max(life["megabytes"] for life in lives),
        "stored": max(life["stored"] for life in lives),
    }


def life_in(size: Sequence[float]) -> dict:
    """What a life in one building measures of itself, in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        return measured_inside(_LIFE, *size, TASKS, folder)
