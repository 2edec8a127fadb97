"""C5.8: searches start where they say, grasps are carried by hand, and measures by hand."""

from itertools import islice

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.scene import Scene
from lifelore.perception.topology.grasp_seeds import GraspSeed
from reproduction.chapter5.c5_08_grasps.parallel_gripper import OPENING, Grasp
from reproduction.chapter5.c5_08_grasps.run import equal_topologies, measure, transferred
from reproduction.chapter5.c5_08_grasps.searches import anywhere, around, carried, from_above, from_seeds
from tests.perception.conftest import interface

DOWN, ALONG = np.array([0.0, 0.0, -1.0]), np.array([0.0, 1.0, 0.0])
RNG = np.random.default_rng


def on_the_table(*places):
    """Object 2 with contact points at `places` to the table."""
    cloud = LabelledCloud(np.array(places, float), np.full(len(places), 2))
    return Scene(cloud, (interface(2, TABLE, places),))


def test_seeds_come_first_as_they_are_and_wide_seeds_not_at_all():
    seeds = [
        GraspSeed(2, "edge", np.full(3, float(k)), DOWN, ALONG, width)
        for k, width in enumerate((0.05, OPENING + 0.01))
    ]
    first, second = islice(from_seeds(seeds, RNG(0)), 2)
    assert (first.position == 0.0).all()
    assert np.linalg.norm(second.position) < 0.1
    assert second.closing @ second.approach == pytest.approx(0.0)
    assert list(from_seeds(seeds[1:], RNG(0))) == []


@pytest.mark.parametrize("search", [anywhere, from_above])
def test_unseeded_grasps_are_poses_at_the_object(search):
    points = RNG(0).uniform(0, 0.1, (50, 3))
    for grasp in islice(search(points, RNG(1)), 20):
        assert [np.linalg.norm(way) for way in (grasp.approach, grasp.closing)] == pytest.approx([1.0, 1.0])
        assert grasp.approach @ grasp.closing == pytest.approx(0.0, abs=1e-12)
        assert grasp.approach[2] <= 0
        assert np.abs(grasp.position - 0.05).max() <= 0.06 + 0.01


def test_a_grasp_is_carried_along_a_longer_object_that_is_turned():
    first, second = on_the_table((0, 0, 0), (0.1, 0, 0)), on_the_table((1, 0, 0), (1, 0.2, 0))
    grasp = Grasp(np.array([0.1, 0.0, 0.03]), DOWN, ALONG)
    nodes = {(2, 0): (2, 0), (2, 1): (2, 1)}
    found, turned = carried(grasp, first, 2, second, 2, nodes)
    assert found.position == pytest.approx([1.0, 0.2, 0.03])
    assert found.closing == pytest.approx([-1.0, 0.0, 0.0])
    assert turned.position == pytest.approx([1.0, 0.0, 0.03])
    assert found.approach == pytest.approx(DOWN)
    assert next(around([found], RNG(0))) is found


def test_topology_is_equal_whatever_the_places():
    two, other = on_the_table((0, 0, 0), (0.1, 0, 0)), on_the_table((0, 0, 0), (0, 0.3, 0))
    assert len(equal_topologies(two, other)) == 2  # either contact point may be either
    assert equal_topologies(two, on_the_table((0, 0, 0))) == []


class Gripper:
    """Grasps straight from above succeed on objects with these numbers, from 0; others on all other objects."""

    def __init__(self, *numbers):
        self.numbers = numbers

    def succeeds(self, grasp, number):
        return (grasp.approach[2] == -1) == (number in self.numbers)


@pytest.mark.parametrize("order", [1, -1])
def test_a_carried_grasp_counts_by_the_mean_over_correspondences_in_whatever_order(order):
    places = [(0, 0, 0), (0.1, 0, 0)]
    cloud = LabelledCloud(np.array(places * 2, float), np.array([2, 2, 3, 3]))
    scene = Scene(cloud, (interface(2, TABLE, places), interface(3, TABLE, places)))
    same = [
        {(2,): (2,), (2, 0): (2, 0), (2, 1): (2, 1)},  # the grasp of object 2 is from above
        {(3,): (2,), (3, 0): (2, 0), (3, 1): (2, 1)},  # that of object 3 is not
        {(3,): (2,), (3, 0): (3, 0), (3, 1): (3, 1)},  # contact points of another object: nothing is carried
    ]
    found = transferred([Gripper(0), Gripper(0)], [scene, scene], same[::order], 2, (0, "test"))
    assert found == {"carried": 0.5, "not carried": False, "above, not carried": True}


def test_measures_by_hand():
    row = {"scene": "a", "seeds": 1, "seeded": True, "anywhere": False, "above": True}
    moved = {"carried": 0.5, "not carried": False, "above, not carried": False}
    objects = [row | moved, {**row, "scene": "b", "above": False}, {**row, "seeds": 0, "anywhere": True}]
    found = {name: number.value for name, number in measure({}, [{"objects": objects}]).items()}
    assert (found["seeded"], found["anywhere"], found["above"]) == (1.0, 0.0, 0.5)
    assert (found["carried"], found["not_carried"]) == (0.5, 0.0)
    assert (found["seeded_less_anywhere"], found["carried_less_not_carried"]) == (1.0, 0.5)
