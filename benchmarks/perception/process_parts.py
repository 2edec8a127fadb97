"""Parts of a process of ``lifelore perceive FILE --json``: start of Python, imports, each step of the work."""

import json
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

from lifelore.core.errors import LifeloreError

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
from lifelore.app import command_line, console
from lifelore.app.perceive_command import _one_thread_for_matrices
_one_thread_for_matrices()
from lifelore.agent.perceive import perceive
from lifelore.core.compiled import machine_code
from lifelore.perception import perceived_scene, scene_json
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


def process_parts(cloud: Path, environment: dict[str, str]) -> dict[str, float]:
    """Processor seconds of each of `PARTS`, and of the work `AGAIN`, in a fresh process.

    Raises
    ------
    LifeloreError
        The process does not end well.
    """
    command = [sys.executable, "-c", _PROCESS, str(cloud)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise LifeloreError(f"a timed process must end well, got '{reason}'")
    measured = json.loads(done.stdout)
    ends = measured["first"]
    seconds = [ends[0], *(end - begin for begin, end in pairwise(ends))]
    return dict(zip(PARTS, seconds, strict=True)) | {AGAIN: measured["again"]}
