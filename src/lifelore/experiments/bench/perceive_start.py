"""Time of ``lifelore perceive`` from the shell: the whole process of one cloud, and each further cloud in it."""

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from lifelore.core.errors import LifeloreError
from lifelore.core.protocols import Progress
from lifelore.domains.scene_folder import save_cloud
from lifelore.domains.tabletop import TabletopSettings, draw_scene
from lifelore.experiments.bench.rounds import at_most, row
from lifelore.experiments.real_scenes import real_scenes_folder

WHOLE, FURTHER = 1.4, 0.5
"""Most seconds of processor time: a process of one cloud, and each further cloud."""
SEED = 7004
REAL = ("learn22", "test47", "test49", "test45")
"""Real scenes of three to seven objects; the first is the one cloud, the others are the further ones."""
SIMULATED = (3, 4, 5, 6)
"""Objects of the simulated scenes that stand in for them."""


@dataclass(frozen=True)
class Cost:
    """Seconds of a process: by the clock, and of all processors (user and system)."""

    wall: float
    cpu: float


def perceive_start(repeats: int, progress: Progress) -> dict:
    """Rows and goals, medians over rounds; see `lifelore.experiments.bench.bench`.

    A round is a process of one cloud and a process of several that begin with it. A further cloud's cost is the
    difference of the two by the number of further clouds, so it holds all that a user waits for. One round before
    the others fills the cache of kernels.
    """
    one, further = [], []
    with tempfile.TemporaryDirectory() as folder:
        sources, what = start_clouds(Path(folder))
        environment = installed_environment(Path(folder))
        perceive_cost(sources, environment)
        for number in range(repeats):
            alone, together = (perceive_cost(clouds, environment) for clouds in (sources[:1], sources))
            more = len(sources) - 1
            one.append(alone)
            further.append(Cost((together.wall - alone.wall) / more, (together.cpu - alone.cpu) / more))
            progress(number + 1, repeats, "round")
    whole, each = (f"lifelore perceive, {what}, {part}" for part in ("whole process", "each further cloud"))
    rows = [
        row(f"{name}, {kind}", median(getattr(cost, field) for cost in costs), "s")
        for name, costs in ((whole, one), (each, further))
        for kind, field in (("wall", "wall"), ("processor", "cpu"))
    ]
    goals = [at_most(f"{rows[1]['name']}, s", WHOLE, rows[1]["value"])]
    goals += [at_most(f"{rows[3]['name']}, s", FURTHER, rows[3]["value"])]
    return {"rows": rows, "goals": goals}


def start_clouds(folder: Path) -> tuple[list[Path], str]:
    """Four real Kinect clouds where they are, else simulated ones written to `folder`; and what to call them."""
    real = real_scenes_folder()
    if real is not None and all((real / f"{name}.pcd").is_file() for name in REAL):
        return [real / f"{name}.pcd" for name in REAL], "a Kinect's PCD"
    sources = [folder / f"scene{number}.pcd" for number in range(len(SIMULATED))]
    for number, (source, things) in enumerate(zip(sources, SIMULATED, strict=True)):
        save_cloud(source, draw_scene(SEED, number, TabletopSettings(n_objects=(things, things))))
    return sources, "a simulated camera's PCD"


def installed_environment(folder: Path) -> dict[str, str]:
    """The environment of a process in which modules are kept as bytecode, as in an installed package."""
    environment = os.environ | {"PYTHONPYCACHEPREFIX": str(folder / "bytecode")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    return environment


def perceive_cost(clouds: Sequence[Path], environment: dict[str, str]) -> Cost:
    """What one process of ``lifelore perceive CLOUD… --json`` costs, from its start to its end.

    Raises
    ------
    LifeloreError
        The process does not end well.
    """
    command = [sys.executable, "-m", "lifelore.app.command_line", "perceive", *map(str, clouds), "--json"]
    before, began = _children_seconds(), time.perf_counter()
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    cost = Cost(time.perf_counter() - began, _children_seconds() - before)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise LifeloreError(f"a timed process must end well, got '{reason}'")
    return cost


def _children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
