"""Scene: merged networks, contact edges in the merged numbering, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from lifelore.core.errors import InputError

POINT = np.zeros((1, 3))


def test_ball_on_block_on_ground_as_printed(make_scene, meet):
    # Fig. 2.2: ball A (2) on block B (3) on ground G (the table).
    scene = make_scene({2: POINT, 3: POINT}, [meet(2, 3, [[0, 0, 0.1]]), meet(3, 1, [[0, 0, 0]])])
    assert [len(scene.networks[label].nodes) for label in (1, 2, 3)] == [1, 1, 2]
    assert scene.networks[3].edges.tolist() == [[0, 1]]
    assert [(e.a, e.node_a, e.b, e.node_b) for e in scene.contact_edges] == [(2, 0, 3, 0), (3, 1, 1, 0)]


def test_contact_edges_point_at_the_nodes_they_join_after_merging(make_scene, meet):
    parts = [
        meet(2, 3, [[0, 0, 1], [1, 0, 1]]),
        meet(2, 4, [[0, 5, 2]]),
        meet(3, 4, [[7, 0, 0], [8, 0, 0], [9, 0, 0]]),
    ]
    scene = make_scene({2: POINT, 3: POINT, 4: POINT}, parts)
    assert len(scene.contact_edges) == 6
    for edge in scene.contact_edges:
        node = scene.networks[edge.a].nodes[edge.node_a]
        assert node.other == edge.b
        assert scene.networks[edge.b].nodes[edge.node_b].other == edge.a
        # The builder puts both contacts of a pair in one place.
        assert np.array_equal(scene.position(edge.a, edge.node_a), scene.position(edge.b, edge.node_b))
        assert edge.length == 0


def test_an_object_that_touches_nothing_has_an_empty_network(make_scene):
    scene = make_scene({2: POINT, 5: POINT})
    assert scene.objects == (2, 5)
    assert all(not scene.networks[label].nodes for label in (2, 5))
    assert 1 not in scene.networks


def test_a_relation_is_found_from_either_side(make_scene):
    scene = make_scene({2: POINT, 3: POINT}, relations=[(3, 2, "on")])
    assert scene.relation_of(2, 3) is scene.relation_of(3, 2) is scene.relations[0]
    assert scene.relation_of(2, 1) is None


def test_mere_neighbours_have_no_nodes_among_what_bears(make_scene, meet):
    parts = [meet(2, 3, [[0, 0, 0]]), meet(2, 4, [[1, 0, 0]]), meet(3, 4, [[2, 0, 0]])]
    scene = make_scene(dict.fromkeys((2, 3, 4), POINT), parts, [(2, 3, "none"), (4, 2, "on")])
    assert [len(scene.without_unrelated_contacts.networks[label].nodes) for label in (2, 3, 4)] == [1, 1, 2]
    assert scene.without_unrelated_contacts.relations == scene.relations


def test_strangers_and_doubled_pairs_are_refused(make_scene, meet):
    with pytest.raises(InputError, match="interface"):
        make_scene({2: POINT}, [meet(2, 3, [[0, 0, 0]])])
    with pytest.raises(InputError, match="relation"):
        make_scene({2: POINT}, relations=[(2, 9, "on")])
    with pytest.raises(InputError, match="once"):
        make_scene({2: POINT, 3: POINT}, [meet(2, 3, [[0, 0, 0]]), meet(3, 2, [[0, 0, 1]])])


def test_an_unproven_scene_stays_unproven(make_scene, meet):
    scene = make_scene({2: POINT, 3: POINT}, [meet(2, 3, [[0, 0, 0]])])
    assert scene.optimal
    assert not replace(scene, optimal=False).without_unrelated_contacts.optimal


@pytest.mark.parametrize("optimal", [True, False])
def test_perception_says_whether_its_scene_is_proven(monkeypatch, make_scene, box, optimal):
    from lifelore.perception import scene_perception as module

    decide = module.most_likely_scene
    monkeypatch.setattr(
        module, "most_likely_scene", lambda *given, **options: replace(decide(*given, **options), optimal=optimal)
    )
    blocks = {2: box([0, 0, 0.002], [0.05, 0.05, 0.05]), 3: box([0.053, 0, 0.002], [0.1, 0.05, 0.05])}
    cloud = make_scene({1: box([-0.1, -0.1, -0.01], [0.2, 0.15, 0]), **blocks}).cloud
    assert module.perceived_scene(cloud).optimal is optimal
    assert module.perceived_scene(cloud, consistent=False).optimal
