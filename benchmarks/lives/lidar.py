"""`bench lidar`: what are remembered transitions for to a robot that sees at a distance?

Each round is one life of `TASKS` tasks for each range, by `lore` and `rmax` beside `scratch`, on the same tasks.
With a lidar, `model` lives as `lore`, and `prior` and `frontier` as `scratch`, so they are left out.
"""

import tempfile
from collections.abc import Sequence
from pathlib import Path

from benchmarks.rounds import at_most, estimated_row, row
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings, SensorSettings
from lifelore.agent.live.summary import third
from lifelore.core.metrics import mean_estimate, ratio_estimate
from lifelore.core.protocols import Progress
from lifelore.domains.worlds import WorldSettings

TASKS = 30
RANGES = (2.0, 5.0, 10.0)
"""Ranges of the lidar in metres."""
MEASURES = {"steps_to_goal": "steps until the goal is seen", "steps_to_80": "steps to 80 %"}
MOST_RATIO = 0.75
"""Most steps of `lore` to 80 %, as ratio to scratch over the last third of the tasks."""


def bench_lidar(repeats: int, progress: Progress, map: str | None = None) -> dict:
    """Rows and goals; see `benchmarks.bench`. `map`: a ROS map; default generated offices."""
    rows, goals = [], []
    for number, reach in enumerate(RANGES):
        tasks = []
        for seed in range(repeats):
            tasks += _last_tasks(WorldSettings(map=map, seed=seed), reach)
            progress(number * repeats + seed + 1, len(RANGES) * repeats, f"{reach:g} m, life {seed}")
        rows += _rows(tasks, reach)
        ratio = ratio_estimate(_column(tasks, "lore", "steps_to_80"), _column(tasks, "scratch", "steps_to_80"))
        goals.append(at_most(f"lore / scratch, {reach:g} m, steps to 80 %", MOST_RATIO, ratio.value))
        hits = sum(sum(_column(tasks, agent, "collisions")) for agent in tasks[0])
        goals.append(at_most(f"collisions of all agents, {reach:g} m", 0, hits))
    return {"rows": rows, "goals": goals}


def _last_tasks(world: WorldSettings, reach: float) -> list[dict]:
    """The results of each agent in the last third of a life."""
    found: list[dict] = []
    for agent in ("lore", "rmax"):
        with tempfile.TemporaryDirectory() as folder:
            memory = MemorySettings(str(Path(folder) / "life.db"))
            sensor = SensorSettings("lidar", reach)
            settings = LifeSettings(
                world, memory=memory, agent=agent, tasks=TASKS, sensor=sensor, compare=True, jobs=1
            )
            report = live(settings).report
        last = [task["agents"] for task in third(report["tasks"], "last")]
        found = [a | b for a, b in zip(found, last, strict=True)] if found else last
    return found


def _column(tasks: Sequence[dict], agent: str, measure: str) -> list[float]:
    return [task[agent][measure] for task in tasks]


def _rows(tasks: Sequence[dict], reach: float) -> list[dict]:
    """Means and ratios to scratch with their 95 % intervals, then how many tasks met the cap."""
    rows = []
    for measure, unit in MEASURES.items():
        scratch = _column(tasks, "scratch", measure)
        for agent in ("scratch", "rmax", "lore"):
            own = _column(tasks, agent, measure)
            name, reference = (f"{who}, {reach:g} m, {unit}" for who in (agent, "scratch"))
            ratio = None if agent == "scratch" else ratio_estimate(own, scratch)
            rows.append(estimated_row(name, mean_estimate(own), unit, reference, ratio))
    for agent in ("scratch", "rmax", "lore"):
        capped = sum(not reached for reached in _column(tasks, agent, "reached"))
        rows.append(row(f"{agent}, {reach:g} m, capped tasks of {len(tasks)}", float(capped), "tasks"))
    return rows
