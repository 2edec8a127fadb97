"""Holes: Fig. 2.6's loop is found, one long contact split in two is not, whatever the density of points."""

import networkx as nx
import numpy as np
import pytest

from lifelore.core import InputError, LabelledCloud, stream
from lifelore.perception.contacts.interface import interfaces
from lifelore.perception.scene import Scene
from lifelore.perception.topology.holes import contact_graph, contact_loops, find_holes, opening_along


def bridge(box, spacing=0.005, legs=((0, 0.04), (0.16, 0.2))):
    """3, a plank, over 2, a block with two prongs: they meet at both ends, 0.06 apart between."""
    parts = [box([0, 0, 0], [0.2, 0.05, 0.02], spacing)]
    parts += [box([low, 0, 0.02], [high, 0.05, 0.08], spacing) for low, high in legs]
    return {2: np.concatenate(parts), 3: box([0, 0, 0.082], [0.2, 0.05, 0.1], spacing)}


ENDS = [[0.02, 0, 0.081], [0.18, 0, 0.081]]


def test_two_contacts_with_a_way_through_make_one_hole(make_scene, box, meet):
    scene = make_scene(bridge(box), [meet(2, 3, ENDS)])
    (hole,) = find_holes(scene)
    assert hole.objects == (2, 3)
    assert hole.nodes == ((2, 0), (2, 1), (3, 1), (3, 0))
    # There and back between contacts 0.16 apart; the builder's facing contacts lie in one place.
    assert hole.size == pytest.approx(0.32)
    assert hole.opening == pytest.approx(0.062, abs=0.001)
    assert np.allclose(hole.centre, [0.1, 0, 0.081])


@pytest.mark.parametrize("spacing", [0.003, 0.006, 0.01])
def test_one_long_contact_split_in_two_is_no_hole_at_any_density(make_scene, box, meet, spacing):
    clouds = bridge(box, spacing, legs=((0, 0.2),))
    scene = make_scene(clouds, [meet(2, 3, ENDS)])
    assert len(contact_loops(scene)) == 1
    assert find_holes(scene) == ()
    assert len(find_holes(make_scene(bridge(box, spacing), [meet(2, 3, ENDS)]))) == 1


def test_a_gap_that_looks_wide_all_along_is_still_one_contact(make_scene, box, meet):
    # Faces in contact are hidden from the camera: 25 mm of visible gap all the way, ends included.
    clouds = bridge(box, legs=((0, 0.2),))
    clouds[3] = clouds[3] + [0, 0, 0.025]
    assert find_holes(make_scene(clouds, [meet(2, 3, ENDS)])) == ()


@pytest.mark.parametrize(("depth", "n_holes"), [(0.010, 0), (0.025, 1)])
def test_what_a_finger_does_not_enter_is_no_hole(make_scene, box, meet, depth, n_holes):
    parts = [box([0, 0, 0], [0.2, 0.05, 0.08 - depth])]
    parts += [box([low, 0, 0.08 - depth], [low + 0.04, 0.05, 0.08]) for low in (0, 0.16)]
    clouds = {**bridge(box), 2: np.concatenate(parts)}
    assert len(find_holes(make_scene(clouds, [meet(2, 3, ENDS)]))) == n_holes


@pytest.mark.parametrize(
    ("relation", "gap", "n_holes"),
    [("none", 0.0, 0), ("adjacent", 0.016, 0), ("adjacent", 0.014, 1), ("on", 0.03, 1), (None, 0.03, 0)],
)
def test_only_contacts_that_close_the_way_make_a_loop(make_scene, box, meet, relation, gap, n_holes):
    stated = [(3, 2, relation)] if relation else []
    scene = make_scene(bridge(box), [meet(2, 3, ENDS, gap)], stated)
    assert len(find_holes(scene)) == n_holes


@pytest.mark.parametrize(
    ("backdrop", "screen", "n_holes"), [(True, False, 1), (False, False, 0), (True, True, 0), (False, True, 0)]
)
def test_an_opening_must_be_seen_through(make_scene, box, meet, backdrop, screen, n_holes):
    # The camera looks along y through the opening; behind it a wall, before it perhaps a box.
    clouds = bridge(box)
    aside = np.array([5.0, 0, 0])
    clouds[4] = box([-0.1, 0.3, -0.1], [0.3, 0.31, 0.3], 0.004) + (0 if backdrop else aside)
    clouds[5] = box([0.05, -0.3, 0], [0.15, -0.25, 0.1], 0.004) + (0 if screen else aside)
    camera = np.array([0.1, -0.8, 0.07])
    assert len(find_holes(make_scene(clouds, [meet(2, 3, ENDS)], camera=camera))) == n_holes


def test_what_is_not_seen_opens_nothing(make_scene, box, meet):
    clouds = bridge(box)
    hidden = {label: cloud[(cloud[:, 0] < 0.04) | (cloud[:, 0] > 0.16)] for label, cloud in clouds.items()}
    assert find_holes(make_scene(hidden, [meet(2, 3, ENDS)])) == ()


def test_a_lintel_on_two_posts_closes_a_loop_through_the_table(make_scene, box, meet):
    clouds = {
        1: box([-0.1, -0.1, -0.01], [0.3, 0.15, 0]),
        2: box([0, 0, 0.002], [0.03, 0.05, 0.1]),
        3: box([0.17, 0, 0.002], [0.2, 0.05, 0.1]),
        4: box([0, 0, 0.102], [0.2, 0.05, 0.12]),
    }
    feet = [meet(2, 1, [[0.015, 0, 0]]), meet(3, 1, [[0.185, 0, 0]])]
    heads = [meet(2, 4, [[0.015, 0, 0.1]]), meet(3, 4, [[0.185, 0, 0.1]])]
    (hole,) = find_holes(make_scene(clouds, [*heads, *feet]))
    assert hole.objects == (1, 2, 3, 4)
    assert hole.size == pytest.approx(2 * (0.17 + 0.1))


def test_neighbours_that_touch_down_to_the_table_close_no_hole(make_scene, box, meet):
    clouds = {
        1: box([-0.1, -0.1, -0.01], [0.3, 0.15, 0]),
        2: box([0, 0, 0.002], [0.099, 0.05, 0.1]),
        3: box([0.101, 0, 0.002], [0.2, 0.05, 0.1]),
    }
    parts = [meet(2, 3, [[0.1, 0, 0.05]]), meet(2, 1, [[0.05, 0, 0]]), meet(3, 1, [[0.15, 0, 0]])]
    scene = make_scene(clouds, parts)
    assert len(contact_loops(scene)) == 1
    assert find_holes(scene) == ()


def test_contacts_found_by_the_separator_give_the_same_answers(box):
    rng = stream(0, "holes")
    for legs, n_holes in ((((0, 0.04), (0.16, 0.2)), 1), (((0, 0.2),), 0)):
        clouds = bridge(box, 0.003, legs)
        points = np.concatenate(list(clouds.values()))
        points = points + rng.normal(0, 0.0005, points.shape)
        labels = np.repeat(list(clouds), [len(cloud) for cloud in clouds.values()])
        cloud = LabelledCloud(points, labels)
        assert len(find_holes(Scene(cloud, interfaces(cloud)))) == n_holes


@pytest.mark.parametrize("seed", range(20))
def test_loops_are_as_many_as_independent_cycles_and_pass_a_node_once(make_scene, meet, seed):
    # Six objects that meet in points of a coarse lattice: many ways are equally long, and many have no length.
    rng = stream(seed, "loops")
    pairs = [(a, b) for a in range(2, 8) for b in range(a + 1, 8) if rng.random() < 0.6]
    parts = [meet(a, b, rng.integers(0, 3, (rng.integers(1, 4), 3)) / 10) for a, b in pairs]
    clouds = {label: np.zeros((1, 3)) for label in range(2, 8)}
    scene = make_scene(clouds, parts)
    loops, graph = contact_loops(scene), contact_graph(scene)
    beyond_forest = graph.number_of_edges() - len(graph) + nx.number_connected_components(graph)
    assert len(loops) == beyond_forest > 0
    for loop in loops:
        assert len(set(loop)) == len(loop) >= 3
        assert all(graph.has_edge(x, y) for x, y in zip(loop, loop[1:] + loop[:1], strict=True))
    assert loops == contact_loops(make_scene(clouds, parts))


def test_opening_by_hand():
    # 0.1 m of way, slices of 7.5 mm: the far side 1 mm away but for the stretch from 30 to 70 mm, where it is 40.
    x = np.arange(0.001, 0.1, 0.002)
    own = np.c_[x, np.zeros((len(x), 2))]
    others = own + np.where((x > 0.03) & (x < 0.07), 0.04, 0.001)[:, None] * [0, 0, 1]
    start, end = np.zeros(3), np.array([0.1, 0, 0])
    opening = opening_along(own, others, start, end, 0.015)
    assert opening.width == pytest.approx(0.04, abs=0.001)
    assert opening_along(own, others, start, end, 0.045) is None
    assert opening_along(own, own + np.array([0, 0, 0.04]), start, end, 0.015) is None
    # Its border: from contact to contact along the object, and back 40 mm above.
    near, far = opening.outline[opening.outline[:, 2] < 0.02], opening.outline[opening.outline[:, 2] > 0.02]
    np.testing.assert_allclose(near[[0, -1]], [start, end])
    assert np.all(np.diff(near[:, 0]) > 0)
    assert np.all(np.diff(far[:, 0]) < 0)
    assert far[:, 0].min() > 0.025
    assert far[:, 0].max() < 0.075


def test_clearance_must_be_a_length(make_scene):
    with pytest.raises(InputError, match="clearance"):
        find_holes(make_scene({2: np.zeros((1, 3))}), clearance=0.0)
