"""C2.9: scenes made by hand within one another, and the shares by hand."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import ADJACENT, ON
from lifelore.perception.contacts.contact_points import ContactPoint
from lifelore.perception.contacts.interface import Interface
from lifelore.perception.relations.relation import Relation
from lifelore.perception.scene import Scene
from reproduction.chapter2.c2_09_substructure.measure import measure
from reproduction.chapter2.c2_09_substructure.run import HOSTS, found_in, witness_is_right


def scene(*pairs):
    """Things that meet in pairs (a, b, relation, places (x, z))."""
    things = sorted({TABLE, *(label for pair in pairs for label in pair[:2])})
    cloud = LabelledCloud(np.zeros((len(things), 3)), np.array(things))
    parts = []
    for a, b, _, places in pairs:
        sides = [
            tuple(
                ContactPoint(np.array([x, 0.0, z]), np.array([0.0, 0, 1]), np.zeros(3), 1.0, 9, other)
                for x, z in places
            )
            for other in (b, a)
        ]
        parts.append(Interface(a, b, 0.0, *sides, np.array([(k, k) for k in range(len(places))])))
    return Scene(cloud, tuple(parts), tuple(Relation(a, b, word, 1.0, 0.0) for a, b, word, _ in pairs))


STACK = scene((2, TABLE, ON, [(0, 0)]), (3, 2, ON, [(0, 0.1)]), (4, 3, ON, [(0, 0.2)]))
TWO_CONTACTS = scene((2, TABLE, ON, [(0, 0)]), (3, 2, ON, [(0, 0.1)]), (4, 3, ON, [(-0.05, 0.2), (0.05, 0.2)]))
ROW = scene(
    *((thing, TABLE, ON, [(0.1 * thing, 0)]) for thing in (2, 3, 4)),
    (2, 3, ADJACENT, [(0.25, 0.02)]),
    (3, 4, ADJACENT, [(0.35, 0.02)]),
)


def test_a_stack_is_found_in_two_contacts_and_not_the_reverse():
    assert found_in(STACK, TWO_CONTACTS) == dict.fromkeys(("things", "connected", "ground", "support"), True)
    assert not any(found_in(TWO_CONTACTS, STACK).values())
    assert witness_is_right(STACK, TWO_CONTACTS)


def test_a_row_has_the_skeleton_of_a_stack_and_not_its_support():
    found = found_in(STACK, ROW)
    assert (found["things"], found["support"]) == (True, False)


def test_no_witness_where_nothing_is_found():
    assert witness_is_right(TWO_CONTACTS, STACK) is None


def test_measures_by_hand():
    yes = dict.fromkeys(("things", "connected", "ground", "support"), True)
    no = dict.fromkeys(yes, False)
    row = {
        **dict.fromkeys(HOSTS, no),
        "two contacts": yes,
        "reversed": no,
        "witness": True,
    }
    missed = {**row, "two contacts": no, "witness": None}
    found = measure({}, [{"real": False, "scenes": [row, row, missed], "examples": []}])
    assert found["in_two_contacts_things"].value == pytest.approx(2 / 3)
    assert found["two_contacts_in_stack_things"].value == 0.0
    assert (found["witness_right"].value, found["witness_right"].n) == (1.0, 2)
    assert found["in_row_support"].n == 3
