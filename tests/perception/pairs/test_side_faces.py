"""Side faces beside each other, on blocks."""

import numpy as np

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.pairs.scene_pairs import scene_pairs
from lifelore.perception.pairs.side_faces import pairs_beside


def test_blocks_side_by_side_are_beside_and_a_block_on_a_block_is_not(box):
    parts = {
        TABLE: box((-0.1, -0.1, -0.001), (0.3, 0.2, 0.0), 0.02),
        2: box((0, 0, 0), (0.1, 0.08, 0.05)),
        3: box((0.02, 0.02, 0.052), (0.06, 0.06, 0.1)),
        4: box((0.105, 0, 0), (0.15, 0.08, 0.04)),
    }
    labels = np.repeat(list(parts), [len(part) for part in parts.values()])
    cloud = LabelledCloud(np.vstack(list(parts.values())), labels)
    assert pairs_beside(scene_pairs(cloud)) == {frozenset((2, 4))}
