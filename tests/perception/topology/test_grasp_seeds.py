"""Grasp seeds: between contacts of an object, across it, and through holes."""

import numpy as np
import pytest

from lifelore.perception.topology.grasp_seeds import grasp_seeds
from lifelore.perception.topology.holes import find_holes


def test_a_plank_on_two_ends_is_grasped_across_its_middle_from_above(make_scene, box, meet):
    clouds = {2: box([0, 0.01, 0], [0.2, 0.05, 0.02])}
    scene = make_scene(clouds, [meet(2, 1, [[0.02, 0.01, 0], [0.18, 0.01, 0]])])
    (seed,) = grasp_seeds(scene)
    assert (seed.object_id, seed.kind) == (2, "edge")
    assert np.allclose(seed.position, [0.1, 0.03, 0])
    assert np.allclose(seed.approach, [0, 0, -1])
    assert seed.width == pytest.approx(0.04)


def test_a_post_is_grasped_from_the_cameras_side(make_scene, box, meet):
    parts = [meet(2, 1, [[0, 0, 0]]), meet(3, 2, [[0, 0, 0.2]])]
    clouds = {2: box([-0.02, -0.03, 0], [0.02, 0.03, 0.2]), 3: np.array([[0, 0, 0.21]])}
    scene = make_scene(clouds, parts, camera=np.array([0, -1.0, 0.5]))
    (seed,) = grasp_seeds(scene)
    assert np.allclose(seed.approach, [0, 1, 0])
    assert seed.width == pytest.approx(0.04)
    assert np.allclose(seed.position, [0, 0, 0.1])


def test_a_hole_lifts_the_upper_object_through_its_plane(make_scene, box, meet):
    legs = [box([low, 0, 0.02], [low + 0.04, 0.05, 0.08]) for low in (0, 0.16)]
    clouds = {2: np.concatenate([box([0, 0, 0], [0.2, 0.05, 0.02]), *legs])}
    clouds[3] = box([0, 0, 0.082], [0.2, 0.05, 0.1])
    clouds[4] = box([-0.1, 0.3, -0.4], [0.3, 0.31, 0.3], 0.004)  # what is seen through the hole
    scene = make_scene(clouds, [meet(2, 3, [[0.02, 0, 0.081], [0.18, 0, 0.081]])], camera=np.array([0.1, -1, 0.3]))
    (hole,) = find_holes(scene)
    through = [seed for seed in grasp_seeds(scene) if seed.kind == "hole"]
    assert [seed.object_id for seed in through] == [3]
    assert through[0].width == hole.opening
    assert np.array_equal(through[0].position, hole.centre)


def test_approach_and_closing_are_unit_and_at_right_angles(make_scene, box, meet):
    rng = np.random.default_rng(3)
    for _ in range(30):
        start, end = rng.uniform(-0.1, 0.1, (2, 3))
        cloud = rng.uniform(-0.1, 0.1, (200, 3))
        for seed in grasp_seeds(make_scene({2: cloud}, [meet(2, 1, [start, end])])):
            edge = (end - start) / np.linalg.norm(end - start)
            frame = np.array([edge, seed.approach, seed.closing])
            assert np.allclose(frame @ frame.T, np.eye(3), atol=1e-9)
            assert 0 <= seed.width <= 0.4


def test_contacts_in_one_place_and_single_contacts_give_no_seed(make_scene, box, meet):
    cloud = box([0, 0, 0], [0.1, 0.1, 0.1])
    assert grasp_seeds(make_scene({2: cloud}, [meet(2, 1, [[0, 0, 0], [0, 0, 0]])])) == ()
    assert grasp_seeds(make_scene({2: cloud}, [meet(2, 1, [[0, 0, 0]])])) == ()
