"""Time of a whole scene, stage by stage on one core, and of a cloud from the shell, by parts.

Seconds are of the processor, so that other programs on the machine count little. The wall time of whole processes
and the load of the machine are rows of their own; on a quiet machine, both times are nearly equal.
"""

import os
import tempfile
import time
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from statistics import median

import numpy as np

from benchmarks.perception_stages import STAGES, timed_stages
from benchmarks.process import Cost, installed_environment, measured_inside, process_cost
from benchmarks.rounds import at_most, row
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream
from lifelore.domains.tabletop.scene_folder import save_cloud
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, sample_scene
from lifelore.perception.relations.relation_classifier import shipped_model
from reproduction.chapter2.scenes.real_scenes import real_scenes_folder

THINGS, POINTS = 15, 100_000
SEED = 7003
JITTER = 0.0005
"""Metres by which points are moved that stand in for a denser camera's."""
WHOLE, SHELL, REFUSAL = 0.4, 0.8, 0.3
"""Most seconds of a scene in a program, from the shell, and until a bad file is refused."""
REAL_SCENES = ("learn22", "test47", "test51")
"""Three, four and six objects; the loops of the last need SciPy's graphs."""
BAD = "a PCD that is cut off"

PARTS = (
    "start of Python",
    "imports",
    "relation model",
    "reading",
    "segmentation",
    "contacts",
    "relations",
    "conclusions",
    "writing",
)
AGAIN = "in a program"
"""All of the work once more in the same process, from reading to the written document."""

_PROCESS = """
import time
marks = [time.process_time()]
import json, os, sys
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the verb does
from lifelore.app import command_line, console
from lifelore.agent.perceive import perceive
from lifelore.perception import scene_json, scene_perception
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.contacts.interface import interfaces
from lifelore.perception.reasoning.scene_logic import alternatives, most_likely_scene
from lifelore.perception.relations.relation_classifier import shipped_model
from lifelore.perception.scene import Scene
from lifelore.perception.segmentation.table_frame import to_scene

def done(result):
    marks.append(time.process_time())
    return result

def work():
    read = done(read_cloud(sys.argv[1]))
    cloud = done(to_scene(read))
    found = done(interfaces(cloud, model.settings))
    decided = done(most_likely_scene(alternatives(model.beliefs(cloud, found)), cloud.objects))
    scene = Scene(cloud, found, decided.relations, decided.optimal).without_unrelated_contacts
    document = done(scene_json.scene_document(scene, seconds=0.0))
    with open(os.devnull, "w") as nowhere:
        json.dump(document, nowhere, indent=2)
    done(None)

done(None)
model = done(shipped_model())
work()
first, marks = marks, [time.process_time()]
work()
json.dump({"first": first, "again": marks[-1] - marks[0]}, sys.stdout)
"""


def bench_perceive(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    scene, model = _crowded_scene(), shipped_model()
    clouds = {
        f"{THINGS} objects, {POINTS:,} points of objects and their table": _with_points(
            scene.cloud, of_things=True
        ),
        f"{THINGS} objects, {POINTS:,} points in all": _with_points(scene.cloud, of_things=False),
    }
    timed_stages(next(iter(clouds.values())), model)  # compiled and warm before anything is timed
    times: dict[str, list[dict[str, float]]] = {name: [] for name in clouds}
    costs: dict[str, list[Cost]] = {}
    parts: dict[str, list[dict[str, float]]] = {}
    load: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        sources, environment = _shell_sources(Path(folder), scene), installed_environment(Path(folder))
        bad = Path(folder) / "bad.pcd"
        bad.write_bytes(next(iter(sources.values())).read_bytes()[:1000])
        for source in sources.values():
            process_cost(["perceive", source, "--json"], environment)
            process_parts(source, environment)
        for number in range(repeats):
            load.append(os.getloadavg()[0])
            for name, cloud in clouds.items():
                times[name].append(timed_stages(cloud, model, time.process_time))
            for name, source in sources.items():
                costs.setdefault(name, []).append(process_cost(["perceive", source, "--json"], environment))
                parts.setdefault(name, []).append(process_parts(source, environment))
            costs.setdefault(BAD, []).append(process_cost(["perceive", bad], environment, status=2))
            progress(number + 1, repeats, "round")
    rows = [line for name, rounds in times.items() for line in _shares(name, name, STAGES, rounds)]
    for name in costs:
        rows += _process_rows(name, costs[name], parts.get(name, []))
    rows.append(row("load of the machine, mean of a minute", median(load), "processes"))
    wholes = {name: median(sum(stages.values()) for stages in rounds) for name, rounds in times.items()}
    again = {f"{name}, {AGAIN}": median(part[AGAIN] for part in parts[name]) for name in parts}
    goals = [at_most(f"{name}, s", WHOLE, seconds) for name, seconds in (wholes | again).items()]
    for name in costs:
        cpu = median(cost.cpu for cost in costs[name])
        goals.append(at_most(f"{name}, from the shell, s", REFUSAL if name == BAD else SHELL, cpu))
    return {"rows": rows, "goals": goals}


def process_parts(cloud: Path, environment: dict[str, str]) -> dict[str, float]:
    """Processor seconds of each of `PARTS`, and of the work `AGAIN`, in a fresh process."""
    measured = measured_inside(_PROCESS, cloud, environment=environment)
    ends = measured["first"]
    seconds = [ends[0], *(end - begin for begin, end in pairwise(ends))]
    return dict(zip(PARTS, seconds, strict=True)) | {AGAIN: measured["again"]}


def _process_rows(name: str, costs: list[Cost], parts: list[dict[str, float]]) -> list[dict]:
    """Rows of a verb's whole processes, and of the parts of a process that does the same work."""
    whole = f"{name}, from the shell"
    rows = [
        row(f"{whole}: wall time", median(cost.wall for cost in costs), "s"),
        row(f"{whole}: processor time", median(cost.cpu for cost in costs), "s"),
    ]
    if parts:
        rows += _shares(f"{whole}: all parts", whole, PARTS, parts)
        rows.append(row(f"{name}, {AGAIN}", median(part[AGAIN] for part in parts) * 1e3, "ms"))
    return rows


def _shares(total: str, name: str, parts: Sequence[str], rounds: list[dict[str, float]]) -> list[dict]:
    """Milliseconds of all `parts` together, and of each with its share."""
    whole = [sum(seconds[part] for part in parts) for seconds in rounds]
    rows = [row(total, median(whole) * 1e3, "ms")]
    for part in parts:
        share = median(seconds[part] / all_of_it for seconds, all_of_it in zip(rounds, whole, strict=True))
        own = median(seconds[part] for seconds in rounds)
        rows.append(row(f"{name}: {part}", own * 1e3, "ms", total, share))
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


def _shell_sources(folder: Path, scene: TabletopScene) -> dict[str, Path]:
    """Real Kinect clouds where there are any, else the simulated scene, by name."""
    real = real_scenes_folder()
    if real is not None and all((real / f"{name}.pcd").is_file() for name in REAL_SCENES):
        return {f"a Kinect's PCD ({name})": real / f"{name}.pcd" for name in REAL_SCENES}
    save_cloud(folder / "scene.pcd", scene)
    return {"a simulated camera's PCD": folder / "scene.pcd"}
