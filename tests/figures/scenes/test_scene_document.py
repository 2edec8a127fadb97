"""What is read from the document of `lifelore perceive`."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.figures.scenes.scene_document import read_document


def contact(x):
    return {"xyz": [x, 0.0, 0.0], "normal": [0, 0, 1], "extent": [0, 0, 0], "strength": 1.0}


def document(**more):
    return {
        "objects": [
            {"id": 2, "contact_points": [contact(0), contact(1)], "edges": [[0, 1]]},
            {"id": 3, "contact_points": [contact(2)], "edges": []},
        ],
        "relations": [
            {"a": 3, "b": 2, "relation": "adjacent", "confidence": 0.5, "gap": 0.01},
            {"a": 2, "b": "table", "relation": "on", "confidence": 0.9, "gap": 0.0},
            {"a": 3, "b": 2, "relation": "none", "confidence": 0.9, "gap": 0.0},
        ],
    } | more


def test_names_become_numbers_and_none_is_left_out():
    bonds = read_document(document()).bonds
    assert [(b.a, b.b, b.relation, b.with_table) for b in bonds] == [(2, 1, "on", True), (3, 2, "adjacent", False)]


def test_contacts_and_holes_are_places():
    scene = read_document(
        document(
            contact_edges=[[[2, 1], [3, 0]]],
            holes=[
                {"nodes": [[2, 0], [2, 1], [3, 0]]},
                [[2, 0], [2, 1], [3, 0]],
                {"xyz": [[0, 0, 0], [1, 0, 0], [2, 0, 0]]},
                [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
            ],
        )
    )
    np.testing.assert_array_equal(scene.contact_edges, [[[1, 0, 0], [2, 0, 0]]])
    for hole in scene.holes:
        np.testing.assert_array_equal(hole[:, 0], [0, 1, 2])


def test_the_table_has_no_network_nor_contacts_drawn():
    table = {"id": "table", "contact_points": [contact(5)], "edges": []}
    scene = read_document(
        document(objects=[*document()["objects"], table], contact_edges=[[["table", 0], [2, 0]]])
    )
    assert set(scene.networks) == {2, 3}
    assert scene.contact_edges.shape == (0, 2, 3)


def test_an_empty_document_is_an_empty_scene():
    scene = read_document({})
    assert (scene.networks, scene.bonds, scene.holes) == ({}, (), ())


@pytest.mark.parametrize(
    "more",
    [
        {"contact_edges": [[[2, 2], [3, 0]]]},
        {"contact_edges": [[[9, 0], [3, 0]]]},
        {"holes": [[[2, -1], [3, 0], [2, 0]]]},
        {"objects": [{"id": 2, "contact_points": [contact(0)], "edges": [[0, 1]]}]},
    ],
)
def test_what_is_not_there_is_refused(more):
    with pytest.raises(InputError, match="contact point"):
        read_document(document(**more))
