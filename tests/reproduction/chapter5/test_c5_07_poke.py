"""A fingertip pushes what it meets, and nothing without room; pictures show what moved."""

import numpy as np
import pytest

from lifelore.domains.tabletop.depth_camera import looking_down
from lifelore.domains.tabletop.layout import stand
from lifelore.domains.tabletop.shapes import box
from reproduction.chapter5.c5_07_poking.poke import PokedTabletop

pytest.importorskip("mujoco", reason="needs the extra sim")
pytestmark = pytest.mark.sim


def table(*xs):
    placed = [stand(box(0.08, 0.08, 0.06)).moved(x, 0.0) for x in xs]
    found = PokedTabletop([item.shape for item in placed], [item.pose for item in placed])
    found.settle()
    return found


def test_a_block_moves_by_the_push_and_its_neighbour_not_at_all():
    world = table(0.0, 0.2)
    before = [pose.position for pose in world.poses]
    assert world.poke(np.array([-0.04, 0.0, 0.02]), np.array([0.025, 0.0, 0.0]))
    ways = [after.position - start for after, start in zip(world.poses, before, strict=True)]
    assert ways[0] == pytest.approx([0.025, 0.0, 0.0], abs=0.003)
    assert np.linalg.norm(ways[1]) < 1e-4


def test_without_room_nothing_moves():
    world = table(0.0, 0.085)
    before = [pose.position for pose in world.poses]
    assert not world.poke(np.array([0.045, 0.0, 0.02]), np.array([0.025, 0.0, 0.0]))
    assert all((after.position == start).all() for after, start in zip(world.poses, before, strict=True))


def test_the_picture_follows_the_push():
    world, view = table(0.0), looking_down(0.6, 0.7, 0.0, 0.7)
    middles = []
    for _ in range(2):
        cloud = world.picture(view, "kinect", np.random.default_rng(0))
        middles.append(cloud.of(2).mean(axis=0))
        world.poke(np.array([-0.04, 0.0, 0.02]), np.array([0.03, 0.0, 0.0]))
    assert middles[1][0] - middles[0][0] == pytest.approx(0.03, abs=0.005)
