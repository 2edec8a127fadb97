"""`bench courier`: does the main job pay? Whole lives beside `scratch`, at home and then in another building.

Each round is one life of `TASKS` tasks with every agent, and then a visit: `VISITS` tasks in a generated office
the life has never seen, with the memory of home. Ratios are of means over all rounds, on the same tasks.
"""

import tempfile
from collections.abc import Sequence
from pathlib import Path
from statistics import median

from benchmarks.rounds import at_most, estimated_row, row
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.agent.live.summary import third
from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.core.protocols import Progress
from lifelore.domains.worlds import WorldSettings

TASKS, VISITS = 30, 3
AWAY = 1000
"""Offices visited are drawn from this seed on; none is a home."""
GOALS = {"lore": (0.10, 0.005), "prior": (1.0, 0.03)}
"""Most steps and collisions at home, as ratios to scratch over the last third of the tasks."""
VISIT_GOALS = (1.05, 0.25)
"""The same in the other building, over all its tasks."""
SECONDS = 90.0
"""Most seconds of one life."""


def bench_courier(repeats: int, progress: Progress, map: str | None = None) -> dict:
    """Rows and goals; see `benchmarks.bench`. `map`: a ROS map; default generated offices."""
    lives, visits = [], []
    for seed in range(repeats):
        with tempfile.TemporaryDirectory() as folder:
            path = str(Path(folder) / "life.db")
            at_home = LifeSettings(
                WorldSettings(map=map, seed=seed), memory=MemorySettings(path), agent="all", tasks=TASKS
            )
            lives.append(live(at_home).report)
            progress(2 * seed + 1, 2 * repeats, f"life {seed}")
            away = LifeSettings(
                WorldSettings(seed=AWAY + seed), memory=MemorySettings(path, "guest"), tasks=VISITS
            )
            visits.append(live(away).report)
            progress(2 * seed + 2, 2 * repeats, f"visit {seed}")
    home = [task for report in lives for task in third(report["tasks"], "last")]
    abroad = [task for report in visits for task in report["tasks"]]
    arrivals = [report["tasks"][0] for report in visits]
    rows = [
        *_rows("at home", home),
        *_rows("in another building", abroad),
        *_rows("in the first task there", arrivals),
    ]
    seconds = median(report["seconds"] for report in lives)
    rows.append(row(f"a life of {TASKS} tasks with every agent", seconds, "s"))
    return {
        "rows": rows,
        "goals": [*_home_goals(home), *_visit_goals(abroad), at_most("a life, s", SECONDS, seconds)],
    }


def _column(tasks: Sequence[dict], agent: str, measure: str) -> list[float]:
    return [task["agents"][agent][measure] for task in tasks]


def _ratio(tasks: Sequence[dict], agent: str, measure: str) -> Estimate:
    return ratio_estimate(_column(tasks, agent, measure), _column(tasks, "scratch", measure))


def _rows(where: str, tasks: Sequence[dict]) -> list[dict]:
    """Means and ratios to scratch with their 95 % intervals, then how many tasks met the cap."""
    rows = []
    for measure, unit in (("steps_to_80", "steps to 80 %"), ("collisions", "collisions")):
        for agent in tasks[0]["agents"]:
            name, scratch = (f"{who} {where}, {unit}" for who in (agent, "scratch"))
            ratio = None if agent == "scratch" else _ratio(tasks, agent, measure)
            mean = mean_estimate(_column(tasks, agent, measure))
            rows.append(estimated_row(name, mean, unit, scratch, ratio))
    for agent in tasks[0]["agents"]:
        capped = sum(not reached for reached in _column(tasks, agent, "reached"))
        rows.append(row(f"{agent} {where}, capped tasks of {len(tasks)}", float(capped), "tasks"))
    return rows


def _home_goals(tasks: Sequence[dict]) -> list[dict]:
    goals = []
    for agent, (steps, collisions) in GOALS.items():
        goals.append(
            at_most(f"{agent} / scratch, steps at home", steps, _ratio(tasks, agent, "steps_to_80").value)
        )
        goals.append(
            at_most(f"{agent} / scratch, collisions at home", collisions, _ratio(tasks, agent, "collisions").value)
        )
    return goals


def _visit_goals(tasks: Sequence[dict]) -> list[dict]:
    steps, collisions = VISIT_GOALS
    capped = sum(not task["agents"]["lore"]["reached"] for task in tasks)
    return [
        at_most("lore / scratch, steps in another building", steps, _ratio(tasks, "lore", "steps_to_80").value),
        at_most(
            "lore / scratch, collisions in another building", collisions, _ratio(tasks, "lore", "collisions").value
        ),
        at_most("lore capped in another building", 0, float(capped)),
    ]
