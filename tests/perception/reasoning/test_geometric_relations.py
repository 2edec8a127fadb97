"""`between` and `in` by the points: the cases in which the thesis's definitions fail, and those they share."""

import numpy as np
import pytest

from lifelore.perception.reasoning.geometric_relations import geometric_relations, surrounded_share

EAST, NORTH = np.array([1.0, 0, 0]), np.array([0, 1.0, 0])


def named(scene):
    return {str(fact) for fact in geometric_relations(scene)}


def row(make_scene, box, meet, towards_4):
    """3 at the origin, 2 to its west, 4 in the given direction; contacts at the shared faces."""
    middle = [0, 0, 0.05]
    clouds = {2: box([-0.15, -0.05, 0], [-0.05, 0.05, 0.1]), 3: box([-0.05, -0.05, 0], [0.05, 0.05, 0.1])}
    clouds[4] = box(*(np.array([[-0.05, -0.05, 0], [0.05, 0.05, 0.1]]) + 0.1 * towards_4))
    # A contact's normal points out of the other object: at 2's east face, out of 3 into 2, it is west.
    parts = [meet(2, 3, [(middle - 0.05 * EAST, -EAST)]), meet(3, 4, [(middle + 0.05 * towards_4, -towards_4)])]
    return make_scene(clouds, parts, [(2, 3, "adjacent"), (3, 4, "adjacent")])


def test_in_a_row_the_middle_one_is_between(make_scene, box, meet):
    assert named(row(make_scene, box, meet, EAST)) == {"enclosed_between(3, 2, 4)"}


def test_at_a_corner_nothing_is_between(make_scene, box, meet):
    assert named(row(make_scene, box, meet, NORTH)) == set()


def cup(radius, height, n=400, spacing=0.004):
    """Wall and bottom of a round cup that stands at the origin."""
    turns = np.linspace(0, 2 * np.pi, n, endpoint=False)
    rings = [
        np.c_[radius * np.cos(turns), radius * np.sin(turns), np.full(n, z)] for z in np.arange(0, height, spacing)
    ]
    disc = np.stack(np.meshgrid(*[np.arange(-radius, radius, spacing)] * 2), -1).reshape(-1, 2)
    disc = disc[np.hypot(*disc.T) < radius]
    return np.concatenate([*rings, np.c_[disc, np.zeros(len(disc))]])


def ball(radius, at):
    k = np.arange(600) + 0.5
    polar, turn = np.arccos(1 - 2 * k / 600), np.pi * (1 + 5**0.5) * k
    return at + radius * np.c_[np.cos(turn) * np.sin(polar), np.sin(turn) * np.sin(polar), np.cos(polar)]


def test_a_ball_in_a_cup_is_contained_and_the_cup_is_not_in_the_ball(make_scene, meet):
    clouds = {2: cup(0.06, 0.08), 3: ball(0.03, [0.01, 0, 0.03])}
    scene = make_scene(clouds, [meet(2, 3, [[0, 0, 0]])], [(3, 2, "on")])
    assert named(scene) == {"contained(3, 2)"}


def test_what_a_wide_slab_lies_on_is_not_in_it(box):
    foot, slab = box([-0.03, -0.03, 0], [0.03, 0.03, 0.1]), box([-0.2, -0.2, 0.1], [0.2, 0.2, 0.12])
    assert surrounded_share(foot, slab + np.array([0, 0, 0.001])) == 0


def test_half_the_cup_hidden_is_not_enough_and_three_quarters_are():
    inner = ball(0.03, [0, 0, 0.03])
    wall = cup(0.06, 0.08)
    turn = np.arctan2(wall[:, 1], wall[:, 0]) % (2 * np.pi)
    assert surrounded_share(inner, wall) == 1
    assert surrounded_share(inner, wall[turn < 1.5 * np.pi - 1e-9]) == pytest.approx(0.75)
    assert surrounded_share(inner, wall[turn < np.pi - 1e-9]) == pytest.approx(0.5)


def test_a_block_on_the_foot_of_an_l_and_a_box_on_a_slab_are_in_nothing(make_scene, box, meet):
    l_block = np.concatenate([box([0, 0, 0], [0.2, 0.06, 0.03]), box([0, 0, 0.03], [0.03, 0.06, 0.15])])
    clouds = {2: l_block, 3: box([0.035, 0, 0.031], [0.095, 0.06, 0.09])}
    # By the convex hull, which §2.2 quotes for containment, most of the block is in the L.
    corners = np.array([[0.03, 0.15], [0.2, 0.03]])
    slope = (corners[1, 1] - corners[0, 1]) / (corners[1, 0] - corners[0, 0])
    below = clouds[3][:, 2] <= corners[0, 1] + slope * (clouds[3][:, 0] - corners[0, 0])
    assert below.mean() > 0.9
    scene = make_scene(clouds, [meet(2, 3, [[0.06, 0.03, 0.03]])], [(3, 2, "both")])
    assert named(scene) == set()
    noise = np.random.default_rng(0).normal(0, 0.002, (2, 20_000, 3))
    slab = box([-0.2, -0.2, 0], [0.2, 0.2, 0.02])
    top = box([-0.03, -0.03, 0.02], [0.03, 0.03, 0.1])
    assert surrounded_share(top + noise[0, : len(top)], slab + noise[1, : len(slab)]) < 0.1
