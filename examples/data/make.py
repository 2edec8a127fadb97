"""Makes the example files of this folder again: an office's map, jobs and runs in it, a cloud of a table, a log.

All are simulated. The cloud needs the extra `sim`. Run: python examples/data/make.py
"""

import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image

from lifelore.core.planning.planning import greedy_policy, optimal_q
from lifelore.core.streams import stream
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.buildings.occupancy_map import read_occupancy_map
from lifelore.domains.buildings.office import office_map
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


def make_jobs(folder: Path) -> None:
    """Jobs of one morning between three places of the office."""
    world = make_world("building", map=folder / "office.yaml")
    floor = floor_of(read_occupancy_map(folder / "office.yaml"), world)
    states = stream(0, "example jobs").choice(world.n_states, 3, replace=False)
    places = floor.metres(floor.anchors[states])  # the free point of each place that is farthest from obstacles
    (dock, lab, store) = (f"{x:.3f},{y:.3f}" for x, y in places)
    jobs = [f"09:00,lab,{lab}", f"09:30,store,{store}", f"10:10,dock,{dock}", "10:45,lab,,", "11:15,dock,,"]
    (folder / "jobs.csv").write_text("\n".join(["time,name,x,y", *jobs]) + "\n")


def make_runs(folder: Path) -> None:
    """Twenty runs along shortest paths, with a pose every 0.1 m and localisation noise of 2 cm."""
    world = make_world("building", map=folder / "office.yaml")
    draw, lines = stream(0, "example runs"), ["run,time,x,y,outcome"]
    for run in range(20):
        start, goal = (int(state) for state in draw.choice(world.n_states, 2, replace=False))
        best = greedy_policy(optimal_q(world.task(goal).tables(), world.discount))
        path = [start]
        while path[-1] != goal:
            path.append(int(world.neighbour[path[-1], best[path[-1]]]))
        points = world.positions(np.array(path))
        points = np.vstack([*(np.linspace(a, b, 6)[:-1] for a, b in pairwise(points)), points[-1:]])
        points[1:-1] += draw.normal(0, 0.02, points[1:-1].shape)
        last = len(points) - 1
        lines += [
            f"{run},{0.2 * i:.1f},{x:.2f},{y:.2f},{'goal' if i == last else ''}" for i, (x, y) in enumerate(points)
        ]
    (folder / "runs.csv").write_text("\n".join(lines) + "\n")


def make_cloud(folder: Path) -> None:
    """Four objects on a table, one on another, as a simulated depth camera sees them; each object has a label."""
    from lifelore.domains.tabletop.scene_folder import save_cloud
    from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene

    scene = sample_scene(5, 0, TabletopSettings())
    cloud = scene.cloud
    # A third of the table's points is enough, and makes the file small.
    kept = (cloud.labels > 1) | (stream(0, "example cloud").random(len(cloud.labels)) < 1 / 3)
    cloud = replace(cloud, points=cloud.points[kept], labels=cloud.labels[kept], colours=cloud.colours[kept])
    save_cloud(folder / "table.pcd", replace(scene, cloud=cloud))


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
    for make in (make_map, make_jobs, make_runs, make_log, make_cloud):
        make(place)
