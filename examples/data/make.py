"""Makes the example files of this folder again: two maps of an office, jobs, runs, clouds, a log, walks and keys.

All are simulated. The clouds need the extras `sim` and `ros`. Run: python examples/data/make.py
"""

import json
import sys
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image

from lifelore.agent.teach import MOVE_OF
from lifelore.bridges.mcap_file import mcap_writer
from lifelore.core.planning.planning import greedy_policy, optimal_q
from lifelore.core.streams import stream
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.buildings.occupancy_map import read_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.worlds import make_world

HERE = Path(__file__).parent
POLICIES = ("calm", "dance", "jazz", "news")
MINUTES = {  # mean minutes that a listener stays, with each playlist
    "worker": (42, 18, 25, 20),
    "runner": (15, 38, 22, 24),
    "commuter": (20, 26, 21, 44),
}


def make_map(folder: Path) -> None:
    """A generated office of 34 m × 24 m, as a ROS map."""
    office = office_map(2)
    Image.fromarray(office.grey).save(folder / "office.png", optimize=True)
    (folder / "office.yaml").write_text(
        f"image: office.png\nresolution: {office.resolution}\norigin: [-5.0, -3.0, 0.0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )


def make_new_map(folder: Path) -> None:
    """The same office, mapped again: turned by 3°, with another origin, and with a cupboard where the lab was."""
    office = read_occupancy_map(folder / "office.yaml")
    x, y = next(
        map(float, row.split(",")[2:]) for row in (folder / "jobs.csv").read_text().splitlines() if "lab" in row
    )
    column, row = round((x + 5.0) / office.resolution), len(office.grey) - round((y + 3.0) / office.resolution)
    grey = office.grey.copy()
    grey[row - 6 : row + 6, column - 6 : column + 6] = 0
    unknown = 205
    turned = Image.fromarray(grey).rotate(3, expand=True, fillcolor=unknown)
    turned.save(folder / "office_new.png", optimize=True)
    text = (folder / "office.yaml").read_text().replace("office.png", "office_new.png")
    (folder / "office_new.yaml").write_text(text.replace("[-5.0, -3.0, 0.0]", "[-2.0, -7.5, 0.0]"))


def make_jobs(folder: Path) -> None:
    """Jobs of one morning between three places of the office."""
    world = make_world("building", map=folder / "office.yaml")
    floor = floor_of(read_occupancy_map(folder / "office.yaml"), world)
    states = stream(0, "example jobs").choice(world.n_states, 3, replace=False)
    places = floor.metres(floor.anchors[states])  # the free point of each place that is farthest from obstacles
    (dock, lab, store) = (f"{x:.3f},{y:.3f}" for x, y in places)
    jobs = [f"09:00,lab,{lab}", f"09:30,store,{store}", f"10:10,dock,{dock}", "10:45,lab,,", "11:15,dock,,"]
    (folder / "jobs.csv").write_text("\n".join(["time,name,x,y", *jobs]) + "\n")


def make_courier_jobs(folder: Path) -> None:
    """200 jobs between six rooms of the office that ``lifelore live`` generates: ten working days."""
    world, random = make_world(), stream(1, "courier jobs")
    floor = floor_of(office_map(0), world)
    points = floor.metres(floor.anchors)
    places = points[:1]
    while len(places) < 6:  # each place is as far as can be from those before it
        away = np.hypot(*(points[:, None] - places).T).min(axis=0)
        places = np.vstack([places, points[away.argmax()]])
    ends = dict(zip(("post", "lab", "kitchen", "store", "printer", "desk"), places, strict=True))
    rows, place = [f"{name},{x:.3f},{y:.3f}" for name, (x, y) in ends.items()], "desk"
    while len(rows) < 200:
        place = str(random.choice([name for name in ends if name != place]))
        rows.append(f"{place},,")
    (folder / "courier.csv").write_text("\n".join(["name,x,y", *rows]) + "\n")


def steps_of(world: GridWorld, start: int, goal: int) -> Iterator[tuple[int, int]]:
    """State and action of each step of a shortest path."""
    best = greedy_policy(optimal_q(world.task(goal).tables(), world.discount))
    state = start
    while state != goal:
        yield state, int(best[state])
        state = int(world.neighbour[state, best[state]])


def make_runs(folder: Path) -> None:
    """Twenty runs of a morning along shortest paths, with a pose every 0.1 m and localisation noise of 2 cm."""
    world = make_world("building", map=folder / "office.yaml")
    draw, lines = stream(0, "example runs"), ["run,time,x,y,outcome"]
    for run in range(20):
        start, goal = (int(state) for state in draw.choice(world.n_states, 2, replace=False))
        points = world.positions(np.array([*(state for state, _ in steps_of(world, start, goal)), goal]))
        points = np.vstack([*(np.linspace(a, b, 6)[:-1] for a, b in pairwise(points)), points[-1:]])
        points[1:-1] += draw.normal(0, 0.02, points[1:-1].shape)
        last, start_time = len(points) - 1, 1_704_096_000 + 600 * run  # Monday, 2024-01-01, from 8:00 on
        lines += [
            f"{run},{start_time + 0.2 * i:.1f},{x:.2f},{y:.2f},{'goal' if i == last else ''}"
            for i, (x, y) in enumerate(points)
        ]
    (folder / "runs.csv").write_text("\n".join(lines) + "\n")


def make_night(folder: Path) -> None:
    """A night of a robot between the places of the jobs, as a ROS 2 bag: transforms, goals and a bumper.

    Something that the map lacks stands halfway from the lab to the dock. The robot bumps into it three times, and
    then drives around it.
    """
    world = make_world("building", map=folder / "office.yaml")
    rows = [row.split(",")[1:] for row in (folder / "jobs.csv").read_text().splitlines()[1:4]]
    lab, store, dock = (int(world.states_at([(float(x), float(y))])[0]) for _, x, y in rows)
    driven = [state for state, _ in steps_of(world, lab, dock)]
    crate = driven[len(driven) // 2]
    around = replace(world, neighbour=np.where(world.neighbour == crate, -1, world.neighbour))
    drives = [(world, lab, store), (world, store, dock), (around, dock, lab), *[(world, lab, dock)] * 3]
    drives += [(around, lab, dock), (around, dock, store), (world, store, lab), (around, lab, dock)]
    draw, clock = stream(0, "example night"), 1_704_146_400  # Monday, 2024-01-01, 22:00
    with mcap_writer(folder / "night.mcap", {}) as write:
        write("/tf_static", *transform("map", "odom", clock, 2.0, -1.0, 0.0))
        for number, (building, start, end) in enumerate(drives):
            states = np.array([*(state for state, _ in steps_of(building, start, end)), end])
            bumps = crate in states and (start, end) == (lab, dock)
            if bumps:
                states = states[: list(states).index(crate)]
            points = world.positions(states) + draw.normal(0, 0.02, (len(states), 2))
            write("/navigate_to_pose/_action/status", *status(number, 2, clock))
            for (x, y), (dx, dy) in zip(points, np.gradient(points, axis=0), strict=True):
                clock += 1
                write("/tf", *transform("odom", "base_link", clock, x - 2.0, y + 1.0, np.arctan2(dy, dx)))
            if bumps:
                write("/bumper", "std_msgs/msg/Bool", {"data": True}, clock * 10**9)
                write("/bumper", "std_msgs/msg/Bool", {"data": False}, clock * 10**9 + 1)
            write("/navigate_to_pose/_action/status", *status(number, 6 if bumps else 4, clock))
            clock += 300


def transform(parent: str, child: str, time: int, x: float, y: float, yaw: float) -> tuple[str, dict, int]:
    """Type, fields and nanoseconds of a message for /tf."""
    header = {"frame_id": parent, "stamp": {"sec": time}}
    turn = {"z": float(np.sin(yaw / 2)), "w": float(np.cos(yaw / 2))}
    pose = {"translation": {"x": float(x), "y": float(y)}, "rotation": turn}
    one = {"header": header, "child_frame_id": child, "transform": pose}
    return "tf2_msgs/msg/TFMessage", {"transforms": [one]}, time * 10**9


def status(goal: int, value: int, time: int) -> tuple[str, dict, int]:
    """Type, fields and nanoseconds of a message about the goal of this number."""
    name = {"goal_id": {"uuid": np.full(16, goal, np.uint8)}}
    one = {"goal_info": name, "status": value}
    return "action_msgs/msg/GoalStatusArray", {"status_list": [one]}, time * 10**9


def make_clouds(folder: Path) -> None:
    """Clouds of tables as a simulated depth camera sees them; each object has a label.

    Four objects, one on another, in `table.pcd`; two objects in `pair.pcd`, and as a message in `pair.bag`.
    """
    from lifelore.domains.tabletop.scene_folder import save_cloud
    from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene

    for name, seed, settings, table_share, object_share in (
        ("table", 5, TabletopSettings(), 1 / 3, 1.0),
        ("pair", 1, TabletopSettings(n_objects=(2, 2)), 1 / 8, 1 / 2),
    ):
        scene = sample_scene(seed, 0, settings)
        cloud = scene.cloud
        assert cloud.colours is not None, "the simulated camera sees colours"
        # A part of the points is enough, and makes the file small.
        share = np.where(cloud.labels > 1, object_share, table_share)
        kept = stream(0, "example cloud").random(len(cloud.labels)) < share
        cloud = replace(cloud, points=cloud.points[kept], labels=cloud.labels[kept], colours=cloud.colours[kept])
        save_cloud(folder / f"{name}.pcd", replace(scene, cloud=cloud))
    write_bag(folder / "pair.bag", cloud.points.astype(np.float32), cloud.labels.astype(np.uint32))


def write_bag(path: Path, points: np.ndarray, labels: np.ndarray) -> None:
    """A ROS 1 bag with one sensor_msgs/PointCloud2 on the topic /camera/points; points (n, 3), labels (n,)."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    types = get_typestore(Stores.ROS1_NOETIC)
    cloud_type, field = "sensor_msgs/msg/PointCloud2", types.types["sensor_msgs/msg/PointField"]
    data = np.rec.fromarrays(
        [*points.T, labels], dtype=[("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("label", "<u4")]
    )
    message = types.types[cloud_type](
        header=types.types["std_msgs/msg/Header"](
            seq=0, stamp=types.types["builtin_interfaces/msg/Time"](0, 0), frame_id="camera"
        ),
        height=1, width=len(data),
        fields=[*(field(name, 4 * i, 7, 1) for i, name in enumerate("xyz")), field("label", 12, 6, 1)],
        is_bigendian=False, point_step=16, row_step=16 * len(data),
        data=np.frombuffer(data.tobytes(), np.uint8), is_dense=True,
    )  # fmt: skip
    path.unlink(missing_ok=True)
    with Writer(path) as bag:
        connection = bag.add_connection("/camera/points", cloud_type, typestore=types)
        bag.write(connection, 0, types.serialize_ros1(message, cloud_type))


def make_walks(folder: Path) -> None:
    """Walks of an expert and of a lost guest in an advice maze, and the keys of a lesson in a noise maze."""
    maze = make_world("advice", seed=3)
    goal = maze.n_states - 1
    draw = stream(0, "example walks")
    walks = [list(steps_of(maze, start, goal)) for start in (0, *draw.choice(goal, 6, replace=False).tolist())]
    guest, place = [], 0
    for move in draw.integers(4, size=400).tolist():  # a refused move leaves the guest in its place
        guest.append((place, move))
        place = int(maze.neighbour[place, move]) if maze.neighbour[place, move] >= 0 else place
    for name, agent, steps in (
        ("ways", "expert", [step for walk in walks for step in [*walk, (goal, None)]]),
        ("steps", "guest", guest),
    ):
        lines = [json.dumps({"agent": agent, "state": state, "action": action}) for state, action in steps]
        (folder / f"{name}.jsonl").write_text("\n".join(lines) + "\n")
    lesson_world, key_of = (
        make_world("noise", seed=0),
        {move: key for key, move in MOVE_OF.items() if len(key) == 1},
    )
    lesson = []
    for number in range(3):  # the goals and starts of `lifelore teach`
        end, start = stream(0, "teach", number).choice(lesson_world.n_states, 2, replace=False).tolist()
        lesson.append("".join(key_of[action] for _, action in steps_of(lesson_world, start, end)))
    (folder / "keys.txt").write_text("\n".join(lesson) + "\n")


def make_log(folder: Path) -> None:
    """Minutes that 240 listeners stayed with four playlists; their three types are not in the log."""
    draw = stream(0, "example log")
    types = draw.choice(len(MINUTES), 240, p=(0.45, 0.35, 0.2))
    mean = np.array(list(MINUTES.values()), float)
    user = np.repeat(np.arange(240), draw.integers(6, 15, 240))
    user = user[draw.permutation(len(user))]
    policy = draw.integers(len(POLICIES), size=len(user))
    minutes = np.maximum(draw.normal(mean[types[user], policy], 7.0), 0.0)
    rows = [f"u{u:03d},{POLICIES[p]},{m:.1f}" for u, p, m in zip(user, policy, minutes, strict=True)]
    (folder / "log.csv").write_text("\n".join(["user,policy,outcome", *rows]) + "\n")


if __name__ == "__main__":
    place = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
    makers = (
        make_map, make_jobs, make_courier_jobs, make_new_map, make_runs, make_night, make_log, make_walks,
        make_clouds,
    )  # fmt: skip
    for make in makers:
        make(place)
