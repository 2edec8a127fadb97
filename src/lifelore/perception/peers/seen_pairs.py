"""What every peer looks at: the same near pairs as ours, found once a scene; and clouds at a coarser grain."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.perception.clouds.voxel import voxelised
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.contacts.near_pairs import NearPair, near_pairs, split_objects

SETTINGS = ContactSettings()


# Peers are asked about one scene after another: a few suffice to look at each scene once for all of them.
@lru_cache(maxsize=8)
def seen_pairs(cloud: LabelledCloud) -> tuple[NearPair, ...]:
    """Near pairs of a scene at the default settings: among objects, then each object with the table."""
    if not cloud.objects:
        return ()
    objects = split_objects(voxelised(cloud, SETTINGS.voxel).cloud)
    return tuple(near_pairs(objects, SETTINGS.near, SETTINGS.table_margin))


def coarse(points: NDArray[np.float64], grain: float) -> NDArray[np.float64]:
    """The mean of the points in each cube of side `grain` metres, shape ``(k, 3)``."""
    return voxelised(LabelledCloud(points, np.ones(len(points), np.int64)), grain).cloud.points
