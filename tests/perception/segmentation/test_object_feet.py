"""The lowest centimetre of an object is the object's; the table around it stays the table."""

import numpy as np

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.segmentation.object_feet import with_feet


def test_the_foot_of_a_wall_is_the_walls_and_the_floor_before_it_stays_table():
    z = np.arange(0.0, 0.06, 0.001)
    wall = np.column_stack([np.zeros_like(z), np.zeros_like(z), z])
    floor = np.column_stack([np.zeros(50), -np.arange(1, 51) * 0.001, np.full(50, 0.002)])
    labels = np.concatenate([np.where(z > 0.010, 5, TABLE), np.full(50, TABLE)])
    found = with_feet(labels, np.concatenate([wall, floor]), np.full(110, 0.010))
    assert (found[:60][z > 0.0036] == 5).all()
    assert (found[:60][z < 0.0034] == TABLE).all()
    assert (found[60:] == TABLE).all()


def test_without_objects_or_without_a_table_nothing_changes():
    points = np.random.default_rng(0).uniform(0, 0.009, (40, 3))
    for label in (TABLE, 3):
        labels = np.full(40, label)
        assert (with_feet(labels, points, np.full(40, 0.01)) == labels).all()
