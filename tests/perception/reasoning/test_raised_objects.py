"""What begins above the table rests on it only where the camera cannot tell."""

import numpy as np

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.reasoning.raised_objects import off_the_table, raised_objects
from lifelore.perception.relations.relation import PairBelief
from lifelore.perception.scene_perception import perceived_scene

CAMERA = np.array([0.0, -0.9, 0.5])
TABLE_POINTS = np.array([(x, y, 0.0) for x in np.arange(-0.4, 0.4, 0.01) for y in np.arange(-0.3, 0.6, 0.01)])


def cloud_of(*objects, camera=CAMERA):
    parts = [TABLE_POINTS, *objects]
    labels = np.repeat(np.arange(1, 1 + len(parts)), [len(part) for part in parts])
    return LabelledCloud(np.concatenate(parts), labels, camera=camera)


def block(x, y, z, length=0.08, width=0.08, height=0.06, step=0.004):
    """The top and the front of a block."""
    a, b, c = (np.arange(0, side, step) for side in (length, width, height))
    top = np.array([(x + i, y + j, z + height) for i in a for j in b])
    return np.concatenate([top, np.array([(x + i, y, z + k) for i in a for k in c])])


def test_a_block_on_a_block_is_raised_and_the_lower_is_not():
    assert raised_objects(cloud_of(block(0, 0, 0), block(0.01, 0.01, 0.062))) == {3}


def test_a_block_in_the_air_is_raised_if_the_camera_sees_past_its_bottom():
    assert raised_objects(cloud_of(block(0, 0, 0.15))) == {2}
    assert raised_objects(cloud_of(block(0, 0, 0.15), camera=None)) == set()


def test_a_block_whose_foot_another_hides_may_stand_on_the_table():
    before = block(-0.02, -0.06, 0, length=0.12, width=0.02, height=0.12)
    behind = block(0, 0.05, 0, height=0.16)
    assert raised_objects(cloud_of(behind[behind[:, 2] > 0.08], before)) == set()


def test_beliefs_of_raised_objects_deny_the_table():
    cloud = cloud_of(block(0, 0, 0), block(0.01, 0.01, 0.062))
    seen = [
        PairBelief(3, TABLE, 0.06, {"none": 0.4, "on": 0.6}),
        PairBelief(2, TABLE, 0.0, {"none": 0.1, "on": 0.9}),
    ]
    kept, denied = off_the_table(seen, cloud)
    assert kept == seen[1]
    assert (denied.a, denied.b, denied.gap) == (3, TABLE, 0.06)
    assert denied.shares == {"none": 0.9, "on": 0.1}


def test_a_scene_states_the_support_that_is_seen():
    scene = perceived_scene(cloud_of(block(0, 0, 0), block(0.02, -0.06, 0.062)))
    assert {(r.relation, r.a, r.b) for r in scene.relations if r.a == 3} == {("on", 3, 2), ("none", 3, 1)}


def test_without_a_table_nothing_is_believed_about_it():
    whole = cloud_of(block(0, 0, 0), block(0.02, -0.06, 0.062))
    bare = LabelledCloud(whole.points[len(TABLE_POINTS) :], whole.labels[len(TABLE_POINTS) :], camera=CAMERA)
    assert all(TABLE not in (one.a, one.b) for one in perceived_scene(bare).beliefs)
