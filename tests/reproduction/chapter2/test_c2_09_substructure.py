"""C2.9: scenes made by hand within one another, and the shares by hand."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import ON
from lifelore.perception.relations.relation import Relation
from lifelore.perception.scene import Scene
from reproduction.chapter2.c2_09_substructure.run import READINGS, found_in, readings
from reproduction.engine.registry import claim_of
from tests.perception.conftest import interface


def scene(*pairs):
    """Things that meet in pairs (a, b, relation, places (x, z))."""
    things = sorted({TABLE, *(label for pair in pairs for label in pair[:2])})
    cloud = LabelledCloud(np.zeros((len(things), 3)), np.array(things))
    parts = tuple(interface(a, b, [(x, 0, z) for x, z in places]) for a, b, _, places in pairs)
    return Scene(cloud, parts, tuple(Relation(a, b, word, 1.0, 0.0) for a, b, word, _ in pairs))


STACK = scene((2, TABLE, ON, [(0, 0)]), (3, 2, ON, [(0, 0.1)]), (4, 3, ON, [(0, 0.2)]))
TWO_CONTACTS = scene((2, TABLE, ON, [(0, 0)]), (3, 2, ON, [(0, 0.1)]), (4, 3, ON, [(-0.05, 0.2), (0.05, 0.2)]))


def test_a_stack_is_found_in_two_contacts_and_not_the_reverse():
    assert found_in(STACK, TWO_CONTACTS) == dict.fromkeys(READINGS, True)
    assert not any(found_in(TWO_CONTACTS, STACK).values())


def test_measures_and_readings_by_hand():
    yes, no = dict.fromkeys(READINGS, True), dict.fromkeys(READINGS, False)
    row = {"in two contacts": yes, "reversed": no}
    missed = {"in two contacts": {**no, "connected": True}, "reversed": no}
    results = [{"scenes": [row, row, missed], "examples": []}]
    measured, _ = claim_of("C2.9").measured({}, results)
    assert measured["stack_in_two_contacts"].value == pytest.approx(2 / 3)
    assert measured["two_contacts_in_stack"].value == 0.0
    found = {cell["subgraph"]: numbers["stack_in_two_contacts"].value for cell, numbers in readings({}, results)}
    assert found == pytest.approx({"objects": 2 / 3, "with the ground": 2 / 3, "connected": 1})
