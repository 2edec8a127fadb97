"""C2.6: the loop and the passage it is measured against, the split contact, and the shares by hand."""

import pytest

from lifelore.core.streams import stream
from lifelore.perception.topology.holes import contact_loops
from reproduction.chapter2.c2_06_same_hole.measure import measure, rows
from reproduction.chapter2.c2_06_same_hole.run import findings, objects_only, split_contact
from reproduction.chapter2.scenes.arranged_scenes import arranged

pytest.importorskip("mujoco")


@pytest.fixture(scope="module")
def hinged():
    return arranged("hole-hinged", 0, 0)


def test_a_hole_is_found_where_the_passage_is(hinged):
    found = findings(objects_only(hinged.cloud), hinged)
    assert (found["passages"], found["holes"], found["real"]) == (1, 1, True)
    assert found["form"] == [2, 2]
    assert 10 < found["opening"] < found["size"] / 2


def test_a_split_contact_has_a_cycle_and_no_passage():
    world = arranged("no-hole", 0, 1)
    cloud = split_contact(world.cloud, stream(0, "split", 1))
    assert len(cloud.points) < len(world.cloud.points)
    assert (cloud.labels == 1).sum() == (world.cloud.labels == 1).sum()
    scene = objects_only(cloud)
    assert len(contact_loops(objects_only(world.cloud))) == 0
    assert len(contact_loops(scene)) == 1
    assert findings(scene, world)["passages"] == 0


def test_a_corner_touches_two_sides_without_a_passage():
    world = arranged("corner", 0, 0)
    assert any(label.relation == "both" for label in world.truth)
    assert findings(objects_only(world.cloud), world)["passages"] == 0


def test_measures_by_hand():
    with_hole = {
        "thing": "arch",
        "loops": 1,
        "holes": 1,
        "passages": 1,
        "form": [2, 2],
        "size": 200.0,
        "opening": 50.0,
    }
    missed = {"thing": "arch", "loops": 0, "holes": 0, "passages": 1}
    odd = {**with_hole, "form": [1, 2], "holes": 2, "real": False, "size": 260.0}
    results = [
        {"kind": "hinged", "scenes": [{**with_hole, "real": True}, missed], "examples": []},
        {"kind": "other", "scenes": [{**with_hole, "real": True}, odd], "examples": []},
        {"kind": "split", "scenes": [{"thing": "box", "loops": 1, "holes": 0, "passages": 0}], "examples": []},
        {"kind": "long", "scenes": [{"thing": "box", "loops": 0, "holes": 0, "passages": 0}], "examples": []},
        {"kind": "corner", "scenes": [{"thing": "box", "loops": 1, "holes": 0, "passages": 0}], "examples": []},
        {"kind": "real", "scenes": [{"scene": "learn0", "holes": 0}], "examples": []},
    ]
    found = measure({}, results)
    assert found["hole_found_hinged"].value == 0.5
    assert found["hole_found_split"].value == 0.0
    assert found["passage_in_truth_hinged"].value == 1.0
    assert found["found_where_the_passage_is"].value == pytest.approx(2 / 3)
    assert found["two_contacts_on_either_side"].value == pytest.approx(2 / 3)
    counted = rows({}, results)
    assert sum(row["scenes"] for row in counted) == 8
    assert counted[-2] == {"kind": "real", "thing": "", "cycles": None, "holes": 0, "scenes": 1}
    assert counted[-1] == {"kind": "split", "thing": "box", "cycles": 1, "holes": 0, "scenes": 1}
