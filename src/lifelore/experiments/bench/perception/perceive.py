"""`bench perceive`: how long a whole scene takes, stage by stage on one core; and a cloud from the shell."""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import numpy as np

from lifelore.core.errors import LifeloreError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.tabletop.scene_folder import save_cloud
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, sample_scene
from lifelore.experiments.bench.rounds import at_most, row
from lifelore.experiments.chapter2.scenes.real_scenes import real_scenes_folder
from lifelore.experiments.chapter2.scoring.perception_stages import STAGES, timed_stages
from lifelore.perception.relations.relation_classifier import shipped_model

THINGS, POINTS = 15, 100_000
SEED = 7003
JITTER = 0.0005
"""Metres by which points are moved that stand in for a denser camera's."""
WHOLE, SHELL = 0.4, 3.0
"""Most seconds."""
REAL_SCENE = "test51"


def bench_perceive(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `lifelore.experiments.bench.bench`."""
    scene, model = _crowded_scene(), shipped_model()
    clouds = {
        f"{THINGS} objects, {POINTS:,} points of objects and their table": _with_points(
            scene.cloud, of_things=True
        ),
        f"{THINGS} objects, {POINTS:,} points in all": _with_points(scene.cloud, of_things=False),
    }
    timed_stages(next(iter(clouds.values())), model)  # compiled and warm before anything is timed
    times: dict[str, list[dict[str, float]]] = {name: [] for name in clouds}
    shell: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        source, what = _shell_source(Path(folder), scene)
        _shell_seconds(source)
        for number in range(repeats):
            for name, cloud in clouds.items():
                times[name].append(timed_stages(cloud, model))
            shell.append(_shell_seconds(source))
            progress(number + 1, repeats, "round")
    rows = [line for name, rounds in times.items() for line in _stage_rows(name, rounds)]
    rows.append(row(f"lifelore perceive, {what}, from the shell", median(shell), "s"))
    wholes = {name: median(sum(stages.values()) for stages in rounds) for name, rounds in times.items()}
    goals = [at_most(f"{name}, s", WHOLE, seconds) for name, seconds in wholes.items()]
    return {"rows": rows, "goals": [*goals, at_most(f"{what}, from the shell, s", SHELL, median(shell))]}


def _stage_rows(name: str, rounds: list[dict[str, float]]) -> list[dict]:
    whole = [sum(stages.values()) for stages in rounds]
    rows = [row(name, median(whole) * 1e3, "ms")]
    for stage in STAGES:
        of = [stages[stage] for stages in rounds]
        part = median(one / all_of_it for one, all_of_it in zip(of, whole, strict=True))
        rows.append(row(f"{name}: {stage}", median(of) * 1e3, "ms", name, part))
    return rows


def _crowded_scene() -> TabletopScene:
    return sample_scene(SEED, 0, TabletopSettings(n_objects=(THINGS, THINGS), camera="stereo", shapes="all"))


def _with_points(cloud: LabelledCloud, *, of_things: bool) -> LabelledCloud:
    """The cloud with exactly `POINTS` points, of its things or in all; points drawn twice are moved a little."""
    rng = stream(SEED, "points", int(of_things))
    among = np.flatnonzero(cloud.labels > TABLE) if of_things else np.arange(len(cloud.points))
    whole, more = divmod(POINTS, len(among))
    drawn = np.concatenate([*[among] * whole, rng.permutation(among)[:more]])
    again = rng.normal(0, JITTER, (len(drawn), 3))
    again[: len(among) if whole else len(drawn)] = 0
    rest = np.flatnonzero(cloud.labels == TABLE) if of_things else drawn[:0]
    points = np.concatenate([cloud.points[drawn] + again, cloud.points[rest]])
    return LabelledCloud(points, cloud.labels[np.concatenate([drawn, rest])], None, cloud.camera)


def _shell_source(folder: Path, scene: TabletopScene) -> tuple[Path, str]:
    """A real Kinect cloud where there is one, else the simulated scene; and what to call it."""
    real = real_scenes_folder()
    if real is not None and (real / f"{REAL_SCENE}.pcd").is_file():
        return real / f"{REAL_SCENE}.pcd", f"a Kinect's PCD ({REAL_SCENE})"
    save_cloud(folder / "scene.pcd", scene)
    return folder / "scene.pcd", "a simulated camera's PCD"


def _shell_seconds(source: Path) -> float:
    command = [sys.executable, "-m", "lifelore.app.command_line", "perceive", str(source), "--json"]
    began = time.perf_counter()
    done = subprocess.run(command, env=dict(os.environ), capture_output=True, text=True, check=False)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise LifeloreError(f"a timed process must end well, got '{reason}'")
    return time.perf_counter() - began
