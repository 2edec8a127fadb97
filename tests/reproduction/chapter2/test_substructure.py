"""Substructure: Fig. 2.10's stacks, controls, and the witness checked."""

import numpy as np

from reproduction.chapter2.scenes.substructure import is_substructure, skeleton, substructures

POINT = np.zeros((1, 3))


def stack(make_scene, meet, contacts, labels=(2, 3, 4)):
    """Objects one above the other, each interface with so many contacts side by side."""
    clouds = dict.fromkeys(labels, POINT)
    parts = []
    for height, (low, high, n) in enumerate(zip(labels[:-1], labels[1:], contacts, strict=True)):
        parts.append(meet(low, high, [[0.05 * k, 0, 0.1 * (height + 1)] for k in range(n)]))
    return make_scene(clouds, parts)


def check_witness(part, whole, found):
    small, large = skeleton(part), skeleton(whole)
    assert set(found) == set(small)
    assert len(set(found.values())) == len(found)
    for x, y, kind in small.edges(data="kind"):
        assert large.edges[found[x], found[y]]["kind"] == kind
    assert all(small.nodes[x]["kind"] == large.nodes[y]["kind"] for x, y in found.items())


def test_a_stack_is_part_of_one_with_two_contacts_and_not_the_other_way(make_scene, meet):
    single = stack(make_scene, meet, (1, 1))
    double = stack(make_scene, meet, (1, 2), labels=(9, 5, 7))
    for found in substructures(single, double):
        check_witness(single, double, found)
    assert is_substructure(single, double)
    assert not is_substructure(double, single)


def test_a_row_on_the_table_is_not_a_stack(make_scene, meet):
    standing = make_scene({2: POINT, 3: POINT}, [meet(2, 1, [[0, 0, 0]]), meet(3, 1, [[0.3, 0, 0]])])
    pile = make_scene({2: POINT, 3: POINT}, [meet(2, 1, [[0, 0, 0]]), meet(3, 2, [[0, 0, 0.1]])])
    assert not is_substructure(standing, pile)
    assert not is_substructure(pile, standing)
    (found,) = substructures(pile, pile)
    assert {own: other for own, other in found.items() if len(own) == 1} == {(1,): (1,), (2,): (2,), (3,): (3,)}


def test_one_more_contact_in_the_middle_takes_the_printed_edge_away(make_scene, meet):
    # Errata E15: the tree over both ends of a plank is one edge; a contact between them replaces it by two.
    ends = [meet(2, 3, [[0, 0, 0]]), meet(2, 4, [[0.2, 0, 0]])]
    clouds = dict.fromkeys((2, 3, 4, 5), POINT)
    part = make_scene({label: clouds[label] for label in (2, 3, 4)}, ends)
    whole = make_scene(clouds, [*ends, meet(2, 5, [[0.1, 0, 0]])])
    assert whole.networks[2].edges.tolist() == [[0, 2], [1, 2]]
    # With the numbers free, the part is found at one end and the middle; with both ends known it is not.
    assert all((5,) in found.values() for found in substructures(part, whole))
    assert is_substructure(part, whole)
    closed = [meet(3, 4, [[0.1, 0.5, 0.5]])]
    triangle = make_scene({label: clouds[label] for label in (2, 3, 4)}, [*ends, *closed])
    larger = make_scene(clouds, [*ends, *closed, meet(2, 5, [[0.1, 0, 0]])])
    assert not is_substructure(triangle, larger)
    assert is_substructure(triangle, larger, networks="connected")
