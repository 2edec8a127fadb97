"""Busy places and passages that can be blocked."""

import numpy as np
import pytest
from scipy.sparse import csgraph

from lifelore.core.streams import stream
from lifelore.domains import GridWorld, make_world
from lifelore.domains.buildings.busy_places import around, blocked_passages, move_graph, on_shortest_ways, without


def test_the_door_between_two_rooms_is_the_busiest_place():
    free = np.ones((5, 11), np.bool_)
    free[:, 5] = False
    free[2, 5] = True
    world = GridWorld.from_free("building", free)
    busy = on_shortest_ways(world, stream(0, "ways"))
    assert busy.sum() == pytest.approx(1)
    assert (busy > 0).all()
    door = int(world.state_of[2, 5])
    assert busy[door] > 3 * np.median(busy)
    assert around(world, door, 1).sum() == 7  # the door and three cells on each side


def test_passages_are_apart_and_leave_the_building_in_one_piece():
    world = make_world("building", seed=4)
    busy = on_shortest_ways(world, stream(0, "ways"))
    passages = blocked_passages(world, stream(0, "passages"), busy, 5, 1)
    assert passages.shape == (5, world.n_states)
    assert passages.any(axis=1).all()
    assert passages.sum(axis=0).max() == 1
    opened = passages.sum(axis=0) == 0
    assert opened.mean() >= 0.9
    part = csgraph.connected_components(move_graph(without(world.neighbour, opened)), directed=False)[1]
    assert len(set(part[opened])) == 1
    assert blocked_passages(world, stream(0, "passages"), busy, 0, 1).shape == (0, world.n_states)
