"""Makes the example clouds of the page /see again: PYTHONPATH=. python tests/app/pages/see_examples.py [FOLDER].

Needs the extra sim.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from lifelore.core import LabelledCloud, stream
from lifelore.domains.tabletop.scene_folder import save_cloud
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop.tabletop import sample_scene
from reproduction.chapter2.scenes.figure_scenes import figure_scene

SHIPPED = Path(__file__).parents[3] / "src" / "lifelore" / "app" / "pages" / "see" / "static" / "examples"
MARGIN = 0.1
"""Metres of table around the objects."""
CROWD = TabletopSettings(n_objects=(4, 6))
EXAMPLES = {
    # name: scene, share of the table's points, of the objects' points, whether it has labels
    "tower": (figure_scene("stack-two-contacts", 1, 0, TabletopSettings()), 0.2, 0.6, True),
    "crowded_table": (sample_scene(3, 0, CROWD), 0.08, 0.25, True),
    "without_labels": (sample_scene(3, 2, CROWD), 0.3, 0.3, False),
}


def make_examples(folder: Path) -> None:
    """Write the clouds as PCD: the objects and the table around them, with a part of the points."""
    for name, (scene, table_share, object_share, labelled) in EXAMPLES.items():
        chosen = _part(scene.cloud, table_share, object_share)
        labels = scene.cloud.labels[chosen]
        assert scene.cloud.colours is not None, "the simulated camera sees colours"
        cloud = replace(
            scene.cloud,
            points=scene.cloud.points[chosen],
            labels=labels if labelled else np.zeros_like(labels),
            colours=scene.cloud.colours[chosen],
        )
        save_cloud(folder / f"{name}.pcd", replace(scene, cloud=cloud))


def _part(cloud: LabelledCloud, table_share: float, object_share: float) -> np.ndarray:
    objects = cloud.points[cloud.labels > 1]
    low, high = objects.min(axis=0)[:2] - MARGIN, objects.max(axis=0)[:2] + MARGIN
    near = ((cloud.points[:, :2] >= low) & (cloud.points[:, :2] <= high)).all(axis=1)
    share = np.where(cloud.labels > 1, object_share, table_share)
    return near & (stream(0, "example cloud").random(len(cloud.labels)) < share)


if __name__ == "__main__":
    make_examples(Path(sys.argv[1]) if len(sys.argv) > 1 else SHIPPED)
