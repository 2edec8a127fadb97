"""Every reader of files and bodies as a function of bytes, with small valid inputs to begin with.

A reader may refuse an input by a `LifeloreError`. Any other error is a finding; so is more than 1 GB of memory.
"""

import io
import json
import struct
import warnings
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from PIL import Image

from lifelore import (
    ActionPrior,
    LabelledCloud,
    PairLabel,
    PolicyLibrary,
    RelationClassifier,
    make_world,
    open_memory,
)
from lifelore.action.demonstrations.demonstrations import demonstrations_from_lines
from lifelore.action.priors.prior_file import prior_bytes, prior_from_bytes
from lifelore.agent.advise.step_lines import read_steps
from lifelore.agent.learn_from.run_log import read_runs
from lifelore.agent.live.goals.job_list import read_jobs
from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.agent.personalise.log.log_reader import LogReader
from lifelore.bridges.rosbag_poses import read_bag_log
from lifelore.core.errors import InputError
from lifelore.core.protocols import Record
from lifelore.domains.buildings.occupancy_map import read_occupancy_map
from lifelore.perception.clouds.camera_intrinsics import read_intrinsics
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.clouds.depth_file import read_depth_image
from lifelore.perception.reasoning.planning_goal import read_goal
from lifelore.perception.relations.relation_model_file import model_from_bytes

Reader = Callable[[bytes], object]
WORLD = make_world("noise", size=9, seed=0)
"""The world of the recorded steps."""


CAMERA = b"fx: 4\nfy: 4\ncx: 2\ncy: 2\nwidth: 4\nheight: 4\n"
GOAL = b"on(o2, o3) and not clear(o4)"
STUDY = b'{"library": {"types": ["t"], "policies": ["a", "b"], "means": [[1, 2]], "deviations": 1}}'


@dataclass(frozen=True)
class Target:
    """A reader under test.

    read : raises `LifeloreError` for what it refuses
    seeds : small inputs that it reads
    """

    read: Reader
    seeds: list[bytes]


@contextmanager
def _as_file(content: bytes, name: str) -> Iterator[Path]:
    with TemporaryDirectory(prefix="fuzz-") as folder:
        path = Path(folder) / name
        path.write_bytes(content)
        yield path


def _of_file(read: Callable[[Path], object], name: str) -> Reader:
    def reader(content: bytes) -> None:
        with _as_file(content, name) as path:
            read(path)

    return reader


MEMBER = b"\0member\0"
"""Stands before each member of a zip archive in an input: its name, a line feed, its bytes."""


def _zipped(read: Callable[[bytes], object]) -> Reader:
    """A reader of a zip archive as a reader of its members, whose check sums a fuzzer would never meet."""

    def reader(content: bytes) -> None:
        file = io.BytesIO()
        with zipfile.ZipFile(file, "w") as packed, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of two members of one name
            for part in content.split(MEMBER)[1:]:
                name, _, inside = part.partition(b"\n")
                packed.writestr(name.decode("latin-1").partition("\0")[0] or "_", inside)
        read(file.getvalue())

    return reader


def _members(archive: bytes) -> bytes:
    with zipfile.ZipFile(io.BytesIO(archive)) as packed:
        return b"".join(MEMBER + name.encode() + b"\n" + packed.read(name) for name in packed.namelist())


def _map(content: bytes) -> None:
    """The YAML file of a map up to a NUL byte, then its image."""
    text, _, image = content.partition(b"\0")
    with _as_file(text, "map.yaml") as path:
        path.with_suffix(".pgm").write_bytes(image)
        read_occupancy_map(path)


def _depth(content: bytes) -> None:
    """The camera as JSON up to a NUL byte, then the depth image."""
    text, _, image = content.partition(b"\0")
    with _as_file(text, "camera.json") as path:
        camera = read_intrinsics(path)
        depth = path.with_name("depth.png")
        depth.write_bytes(image)
        read_depth_image(depth, camera)


def _memory(content: bytes) -> None:
    """Merge an export into an empty memory."""
    with _as_file(content, "other.db") as path, open_memory(path.with_name("own.db")) as memory:
        memory.merge_from(path)


def _service(content: bytes) -> None:
    """A method, an address and a body, each on a line, sent to the HTTP service."""
    from fuzz.service import answer

    if (status := answer(content)) >= 400:
        raise InputError(f"the request was answered {status}")


def _steps(content: bytes) -> None:
    for _ in read_steps(io.StringIO(content.decode("utf-8", "replace")), WORLD, "steps"):
        pass


# ---- seeds -------------------------------------------------------------------------------------------


def _pcd() -> list[bytes]:
    fields = "FIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n"
    head = f"VERSION 0.7\n{fields}WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA "
    text = (head + "ascii\n0 0 1 1\n0.1 0 1 2\n").encode()
    columns = struct.pack("<6f2I", 0, 0.1, 0, 0, 1, 1, 1, 2)
    packed = bytes([len(columns) - 1]) + columns  # LZF of one literal run
    return [
        text,
        (head + "binary\n").encode() + struct.pack("<fffIfffI", 0, 0, 1, 1, 0.1, 0, 1, 2),
        (head + "binary_compressed\n").encode() + struct.pack("<II", len(packed), len(columns)) + packed,
    ]


def _ply() -> list[bytes]:
    head = "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
    text = f"ply\nformat ascii 1.0\n{head}0 0 1\n0.1 0 1\n".encode()
    return [
        text,
        f"ply\nformat binary_little_endian 1.0\n{head}".encode() + struct.pack("<6f", 0, 0, 1, 0.1, 0, 1),
    ]


def _arrays(**arrays: np.ndarray) -> bytes:
    file = io.BytesIO()
    np.savez(file, **arrays)  # type: ignore[arg-type]
    return file.getvalue()


def _npy() -> bytes:
    file = io.BytesIO()
    np.save(file, np.array([[0.0, 0.0, 1.0], [0.1, 0.0, 1.0]]))
    return file.getvalue()


def _depth_seed() -> bytes:
    file = io.BytesIO()
    Image.fromarray(np.full((4, 4), 1000, np.uint16)).save(file, "PNG")
    return (
        json.dumps({"fx": 4, "fy": 4, "cx": 2, "cy": 2, "width": 4, "height": 4}).encode()
        + b"\0"
        + file.getvalue()
    )


def _map_seed() -> bytes:
    text = b"image: map.pgm\nresolution: 0.5\norigin: [0, 0, 0]\n"
    text += b"negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    return text + b"\0P5\n3 2\n255\n" + bytes([254, 254, 0, 205, 254, 254])


def _bag_seed() -> bytes:
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    make = store.types
    stamp = make["builtin_interfaces/msg/Time"](sec=1, nanosec=0)
    place = make["geometry_msgs/msg/Point"](1.0, 2.0, 0.0)
    turn = make["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
    kind = "geometry_msgs/msg/PoseStamped"
    pose = make["geometry_msgs/msg/Pose"](place, turn)
    message = make[kind](make["std_msgs/msg/Header"](stamp, "map"), pose)
    with TemporaryDirectory() as folder:
        with Writer(Path(folder) / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
            topic = writer.add_connection("/pose", kind, typestore=store)
            for second in (1, 2):
                writer.write(topic, second * 10**9, store.serialize_cdr(message, kind))
        return next(Path(folder).glob("bag/*.mcap")).read_bytes()


def _memory_seed() -> bytes:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "seed.db"
        with open_memory(path) as memory:
            record = Record("action_prior", "k", 1, "add", np.arange(2), np.ones(2, np.int64))
            memory.contribute("robot", [record], process="p", seq=0, task={})
            memory.export_to(Path(folder) / "export.db")
        return (Path(folder) / "export.db").read_bytes()


def _prior_seed() -> bytes:
    prior = ActionPrior(2)
    prior.update([3], [[True, False]])
    return prior_bytes(prior)


def _model_seed() -> bytes:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.npz"
        cloud = LabelledCloud(np.random.default_rng(0).uniform(0, 0.05, (60, 3)), np.repeat([2, 3], 30))
        RelationClassifier(method="displacement").fit([cloud], [[PairLabel(2, 3, "on")]]).save(path)
        return path.read_bytes()


def targets() -> dict[str, Target]:
    """All targets by name."""
    library = PolicyLibrary.from_samples([[[1.0, 2.0], [3.0, 1.0]]])
    log = b"user,policy,outcome,time\nada,a,1,2024-01-01\nben,b,0,\n"
    cloud = _of_file(read_cloud, "cloud")
    return {
        "pcd": Target(cloud, _pcd()),
        "ply": Target(cloud, _ply()),
        "npz": Target(cloud, [_arrays(points=np.zeros((2, 3)), labels=np.ones(2, int)), _npy()]),
        "depth": Target(_depth, [_depth_seed()]),
        "camera": Target(_of_file(read_intrinsics, "camera.yaml"), [CAMERA]),
        "bag": Target(_of_file(read_bag_log, "poses.mcap"), [_bag_seed()]),
        "map": Target(_map, [_map_seed()]),
        "jobs": Target(_of_file(read_jobs, "jobs.csv"), [b"time,name,x,y\n08:00,dock,1.0,2.0\n09:00,dock,,\n"]),
        "runs": Target(_of_file(read_runs, "runs.csv"), [b"time,x,y,outcome\n0,1,1,\n1,1.2,1,goal\n"]),
        "log": Target(lambda content: LogReader().read(content, "log", LogFormat()), [log]),
        "memory": Target(_memory, [_memory_seed()]),
        "prior": Target(_zipped(prior_from_bytes), [_members(_prior_seed())]),
        "library": Target(_zipped(PolicyLibrary.from_bytes), [_members(library.to_bytes())]),
        "relations": Target(_zipped(model_from_bytes), [_members(_model_seed())]),
        "demonstrations": Target(
            lambda content: demonstrations_from_lines(content.decode("utf-8", "replace").splitlines()),
            [b'{"task": "a", "agent": "p", "state": 1, "action": 0}\n'],
        ),
        "steps": Target(_steps, [b'{"agent": 1, "state": 2, "action": 0}\n']),
        "goal": Target(lambda content: read_goal(content.decode("utf-8", "replace")), [GOAL]),
        "service": Target(_service, [
            b"PUT\n/v1/studies/s\n" + STUDY,
            b"POST\n/v1/studies/s/decisions\n" + b'{"user": "ada"}',
            b"POST\n/v1/studies/s/decisions/batch\n" + b'{"items": [{"user": "ada"}, {"user": "bo"}]}',
            b"GET\n/v1/memory\n",
        ]),
    }  # fmt: skip
