"""Labels of the table in a cloud whose objects are labelled by masks."""

from dataclasses import replace

import numpy as np

from lifelore.core.labelled_cloud import TABLE, UNLABELLED
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.segmentation.range_noise import band
from lifelore.perception.segmentation.region import over_table
from lifelore.perception.segmentation.table_frame import Up, up_direction
from lifelore.perception.segmentation.table_search import find_table


def with_table(cloud: PointCloud, up: Up = "table") -> PointCloud:
    """The labelled cloud with its points without label on the table labelled as table.

    The table is searched for among the points without label, as in a raw frame; its points are those in the band
    of its plane and within its outline. A cloud with points labelled as table, or in which no table is found,
    stays as it is.

    Parameters
    ----------
    cloud : PointCloud
    up : "table", "z" or (3,) numbers
        As in `segmented_scene`.
    """
    if cloud.labels is None or (cloud.labels == TABLE).any():
        return cloud
    measured = np.flatnonzero(cloud.measured)
    points = cloud.points[measured].astype(np.float64)
    free = cloud.labels[measured] == UNLABELLED
    table = find_table(points, cloud.camera, up_direction(up), free).table
    if table is None:
        return cloud
    labels = cloud.labels.copy()
    labels[measured[free & over_table(points, band(points, cloud.camera), table)[0]]] = TABLE
    return replace(cloud, labels=labels)
