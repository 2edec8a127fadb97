"""C2.6: the loop and the passage it is measured against, the split contact, and the shares by hand."""

import pytest

from lifelore.core.streams import stream
from lifelore.perception.topology.holes import contact_loops
from reproduction.chapter2.c2_06_same_hole.passage import passages
from reproduction.chapter2.c2_06_same_hole.run import findings, measure, objects_only, rows, split_contact
from reproduction.chapter2.scenes.arranged_scenes import arranged

pytest.importorskip("mujoco")


def ways(world):
    return passages(world.shapes, world.poses, world.poses[0].rotation[:, 1])


@pytest.fixture(scope="module")
def hinged():
    return arranged("hole-hinged", 0, 0)


def test_a_hole_is_found_where_the_passage_is(hinged):
    found = findings(objects_only(hinged.cloud), hinged)
    assert found == {"hole": True, "form": [2, 2], "true": True}
    assert len(ways(hinged)) == 1


def test_a_split_contact_has_a_cycle_and_no_passage():
    world = arranged("no-hole", 0, 1)
    cloud = split_contact(world.cloud, stream(0, "split", 1))
    assert len(cloud.points) < len(world.cloud.points)
    assert (cloud.labels == 1).sum() == (world.cloud.labels == 1).sum()
    scene = objects_only(cloud)
    assert len(contact_loops(objects_only(world.cloud))) == 0
    assert len(contact_loops(scene)) == 1
    assert findings(scene, world) == {"hole": False}
    assert ways(world) == []


def test_measures_by_hand():
    right = {"hole": True, "form": [2, 2], "true": True}
    odd = {"hole": True, "form": [1, 2], "true": False}
    missed = {"hole": False}
    results = [
        {"kind": "hinged", "scenes": [right, missed], "examples": []},
        {"kind": "other", "scenes": [right, odd], "examples": [{"example": "a hole"}]},
        {"kind": "split", "scenes": [missed], "examples": []},
    ]
    found = measure({}, results)
    assert found["hole_found_hinged"].value == 0.5
    assert found["hole_found_split"].value == 0.0
    assert found["hole_found_corner"].n == 0
    assert found["found_where_the_passage_is"].value == pytest.approx(2 / 3)
    assert found["two_contacts_on_either_side"].value == pytest.approx(2 / 3)
    assert rows({}, results) == [{"example": "a hole"}]
