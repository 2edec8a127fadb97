"""Makes the example files of this folder again: an office's map, a cloud of a table, a log of choices.

All three are drawn by a generator. The cloud needs the extra `sim`. Run: python examples/data/make.py
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from lifelore.core.streams import stream
from lifelore.domains.buildings.office import office_map

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
    for make in (make_map, make_log, make_cloud):
        make(place)
