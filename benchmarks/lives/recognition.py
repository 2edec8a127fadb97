"""`bench recognition`: is a map that was saved again the same building, and are other buildings other ones?

A life of `TASKS` tasks in a building, then visits of `VISITS` tasks with its memory on each map of `RESAVED`, and
with an empty memory. Then generated offices are compared with the building, and it is compared with itself edited.
"""

import shutil
import tempfile
import time
from pathlib import Path

from benchmarks.lives.resaved_maps import RESAVED, cropped, noisy, refurnished, turned
from benchmarks.rounds import at_most, row
from lifelore.agent.live.buildings.recognition import LEAST_MARGIN, LEAST_MATCH
from lifelore.agent.live.life import live
from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.protocols import Progress
from lifelore.domains.buildings.occupancy_map import OccupancyMap, write_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.buildings.registration import Registration, register
from lifelore.domains.worlds import WorldSettings, map_from_settings

TASKS, VISITS = 30, 10
OTHERS = 2000
"""Offices that are compared with the building are drawn from this seed on."""
MOST_RATIO = 1.2
"""Most steps on a map that was saved again, as ratio to the same map."""
SECONDS = 5.0
"""Most processor seconds of a comparison of two maps."""

EDITS = {
    "turned by 90°": lambda m, n: turned(m, 90.0),
    "turned by 10°, noise": lambda m, n: noisy(turned(m, 10.0), seed=n),
    "turned by 5°, pixels of 0.1 m": lambda m, n: turned(m, 5.0, 0.1),
    "turned by 3°, a tenth of the furniture moved, noise": lambda m, n: noisy(
        turned(refurnished(m, 0.1, n), 3.0), seed=n
    ),
    "turned by 3°, three tenths of the furniture moved, noise": lambda m, n: noisy(
        turned(refurnished(m, 0.3, n), 3.0), seed=n
    ),
    "cropped to 60 %, turned by 3°": lambda m, n: turned(cropped(m, 0.6), 3.0),
}
"""Name → an edit of an office that leaves it the same building."""


def bench_recognition(repeats: int, progress: Progress, map: str | None = None) -> dict:
    """Rows and goals; see `benchmarks.bench`. `map`: a ROS map; default a generated office."""
    total = 2 * repeats + 1
    rows, goals = _visits(WorldSettings(map=map), lambda: progress(1, total, "visits"))
    seconds, false, alike, missed = [], 0, 0, dict.fromkeys(EDITS, 0)
    for n in range(repeats):
        office = office_map(OTHERS + n)
        for other in (office_map(OTHERS + repeats + n), office_map(OTHERS + 2 * repeats + n, 24.0, 16.0)):
            false += _timed(office, other, seconds)
        alike += _timed(office, turned(office_map(OTHERS + n, furniture=n), 3.0), seconds)
        progress(2 * n + 2, total, f"office {n}")
        for name, edit in EDITS.items():
            missed[name] += not _timed(office, edit(office, n), seconds)
        progress(2 * n + 3, total, f"office {n} edited")
    rows.append(row(f"false recognitions among {2 * repeats} other offices", float(false), "offices"))
    rows.append(row(f"false recognitions among {repeats} floors with the same walls", float(alike), "offices"))
    for name, count in missed.items():
        rows.append(row(f"missed of {repeats} offices {name}", float(count), "offices"))
    slowest = max(seconds)
    rows.append(row("comparison of two maps, slowest, processor seconds", slowest, "s"))
    goals.append(at_most("false recognitions", 0, float(false + alike)))
    goals.append(at_most("comparison of two maps, processor seconds", SECONDS, slowest))
    return {"rows": rows, "goals": goals}


def _timed(one: OccupancyMap, other: OccupancyMap, seconds: list[float]) -> bool:
    began = time.process_time()
    found = register(one, other)
    seconds.append(time.process_time() - began)
    return found is not None and recognised(found)


def recognised(found: Registration) -> bool:
    """Whether a registration would recognise the building, were it the only one in memory."""
    clear = found.second is None or found.best.match - found.second.match >= LEAST_MARGIN
    return found.best.match >= LEAST_MATCH and clear


def _visits(world: WorldSettings, done) -> tuple[list[dict], list[dict]]:
    rows, goals = [], []
    occupancy = map_from_settings(world)
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder) / "home"
        home.mkdir()
        write_occupancy_map(home / "home.yaml", occupancy)
        lived = home / "life.db"
        _life(home / "home.yaml", lived, TASKS)
        steps = {}
        for number, (name, resave) in enumerate(RESAVED.items()):
            path = Path(folder) / f"map{number}.yaml"
            write_occupancy_map(path, resave(occupancy) if number else occupancy)
            memory = Path(folder) / f"{number}.db"
            shutil.copy(lived, memory)
            began = time.process_time()
            report = _life(path, memory, VISITS)
            took, building = time.process_time() - began, report["building"]
            steps[name, True] = _mean_steps(report)
            steps[name, False] = _mean_steps(_life(path, Path(folder) / f"{number}-empty.db", VISITS))
            same = steps["the same map", True].value
            known, new = steps[name, True], steps[name, False]
            label = f"steps of a task, {name}"
            rows += [
                row(label, known.value, "steps", "steps of a task, the same map", known.value / same)
                | {"ci95": known.to_dict()["ci95"]},
                row(f"{label}, empty memory", new.value, "steps", label, new.value / known.value),
                row(f"places that agree, {name}", building["agreement"] or 0.0, "share"),
                row(f"walls that match, {name}", building["walls"] or 0.0, "share"),
                row(f"processor seconds of the {VISITS} tasks, {name}", took, "s"),
            ]
            goals.append(at_most(f"steps, {name} / the same map", MOST_RATIO, known.value / same))
    done()
    return rows, goals


def _mean_steps(report: dict) -> Estimate:
    return mean_estimate([task["agents"]["lore"]["steps_to_80"] for task in report["tasks"]])


def _life(path: Path, memory: Path, tasks: int) -> dict:
    settings = LifeSettings(
        WorldSettings(map=path), memory=MemorySettings(str(memory)), tasks=tasks, compare=False
    )
    return live(settings).report
