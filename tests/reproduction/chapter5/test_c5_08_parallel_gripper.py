"""Grasps of blocks by hand: width, friction cones, neighbours and the table."""

import numpy as np
import pytest

from lifelore.domains.tabletop.layout import stand
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.shapes import box
from reproduction.chapter5.c5_08_grasps.parallel_gripper import OPENING, Grasp, GraspedTabletop

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim
DOWN = np.array([0.0, 0.0, -1.0])


def grasp(angle=0.0, height=0.04, x=0.0):
    return Grasp(np.array([x, 0.0, height]), DOWN, about(2, angle) @ [1.0, 0.0, 0.0])


def world(*placed):
    return GraspedTabletop([item.shape for item in placed], [item.pose for item in placed])


def block(length=0.05, width=0.05):
    return stand(box(length, width, 0.06))


def test_a_small_block_is_grasped_from_above():
    assert world(block()).succeeds(grasp(), 0)


def test_a_block_wider_than_the_opening_is_not():
    wide = world(block(OPENING + 0.02))
    assert not wide.succeeds(grasp(), 0)
    assert wide.succeeds(grasp(np.pi / 2), 0)


@pytest.mark.parametrize(("degrees", "held"), [(30, True), (40, False)])
def test_the_cone_of_friction_ends_at_35_degrees(degrees, held):
    # Flat sides of a long bar: the normal leaves the line between the contacts by the turn; atan(0.7) is 35°.
    assert world(block(0.3, 0.04)).holds(grasp(np.pi / 2 + np.radians(degrees)), 0) == held


def test_another_object_is_not_the_target():
    two = world(block(), block().moved(0.3, 0.0))
    assert two.holds(grasp(), 0)
    assert not two.holds(grasp(), 1)


def test_a_neighbour_or_the_table_is_in_the_way():
    beside = block().moved((OPENING + 0.055) / 2, 0.0)
    assert not world(block(), beside).is_reached(grasp())
    assert world(block(), beside).is_reached(grasp(np.pi / 2))
    assert not world(block()).is_reached(grasp(height=0.005))
