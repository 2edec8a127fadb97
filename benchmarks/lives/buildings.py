"""`bench buildings`: what a task costs as buildings grow from 5,000 to 300,000 places, for `lore` and `scratch`.

Each size is a life of `TASKS` tasks in a generated office, in a process of its own whose kernels are compiled. The
first task is the dearest: nothing is known yet, and memory stores all of the building. Reading the map, which a
life does once, is timed apart and taken off the first task. With the figure ``benchmarks/results/buildings.png``.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from statistics import median

from benchmarks.rounds import at_most, row
from lifelore.core.errors import LifeloreError
from lifelore.core.protocols import Progress

SIZES = ((47.0, 35.0, 0.5), (150.0, 150.0, 0.9), (150.0, 150.0, 0.45), (150.0, 150.0, 0.225))
"""Metres of width and height of the office, and of a cell's side."""
TASKS = 3
GOALS = {75_000: 2.0, 300_000: 15.0}
"""Most seconds of a task in the building nearest to so many places."""
MOST_MEMORY = 1000.0
"""Megabytes."""
OUT = Path("benchmarks/results")

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


def bench_buildings(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`. The figure is written with three repeats or more."""
    lives = [_lives(size, repeats, progress, number) for number, size in enumerate(SIZES)]
    rows, goals = [], []
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
    for places, seconds in GOALS.items():
        life = min(lives, key=lambda life: abs(life["places"] - places))
        goals.append(
            at_most(f"a task at {life['places']:,} places, s", seconds, max(life["first"], life["later"]))
        )
    goals.append(at_most("memory of the process, MB", MOST_MEMORY, max(life["megabytes"] for life in lives)))
    if repeats >= 3:
        _draw(lives, out)
    return {"rows": rows, "goals": goals}


def _lives(size: Sequence[float], repeats: int, progress: Progress, number: int) -> dict[str, float]:
    """Medians over repeated lives in one building."""
    lives = []
    for repeat in range(repeats):
        lives.append(_life(size))
        done = number * repeats + repeat + 1
        progress(done, len(SIZES) * repeats, f"{lives[-1]['places']:,} places")
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


def _life(size: Sequence[float]) -> dict:
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-c", _LIFE, *map(str, size), str(TASKS), folder]
        done = subprocess.run(command, env=dict(os.environ), capture_output=True, text=True, check=False)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise LifeloreError(f"a timed life must end well, got '{reason}'")
    return json.loads(done.stdout)


def _draw(lives: Sequence[dict[str, float]], out: Path) -> None:
    from benchmarks.lives.figure_building_growth import draw_building_growth
    from lifelore.figures.style import save_figure

    out.mkdir(parents=True, exist_ok=True)
    series = {key: [life[key] for life in lives] for key in ("places", "first", "later", "megabytes")}
    save_figure(draw_building_growth(**series), out / "bench_buildings.png")
