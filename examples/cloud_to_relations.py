"""A point cloud of three boxes becomes relations that a planner can use.

For robot engineers. `read_cloud` also takes PCD, PLY and npz files; clouds without labels are segmented.
"""

import numpy as np

from lifelore import perceived_scene, read_cloud, to_scene


def box(centre: tuple[float, float, float], size: float, spacing: float = 0.004) -> np.ndarray:
    """Points (n, 3) in metres on the surface of a cube."""
    steps = np.arange(-size / 2, size / 2 + spacing / 2, spacing)
    points = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    return centre + points[np.isclose(np.abs(points).max(axis=1), size / 2)]


table = np.stack(
    [*np.meshgrid(np.arange(-0.4, 0.4, 0.008), np.arange(-0.4, 0.4, 0.008)), np.zeros((100, 100))], -1
)
parts = [table.reshape(-1, 3), box((0, 0, 0.04), 0.08), box((-0.01, 0, 0.11), 0.06), box((0.09, 0, 0.04), 0.08)]
labels = np.repeat([1, 2, 3, 4], [len(part) for part in parts])  # 1 is the table, objects are 2 and above
cloud = read_cloud(np.column_stack([np.vstack(parts), labels]))

scene = perceived_scene(to_scene(cloud, up="z"))
for relation in scene.relations:
    if relation.relation != "none":
        print(f"{relation.relation}({relation.a}, {relation.b})")
