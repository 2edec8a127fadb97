"""Labels of pairs from contacts and gaps written by hand."""

import numpy as np
import pytest

from lifelore.core.relations import PairLabel
from lifelore.domains.tabletop.physics import Contacts
from lifelore.domains.tabletop.truth import Gap, bearing, true_relations

UP, SIDE = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)
SLANT = (np.sin(np.radians(60)), 0.0, np.cos(np.radians(60)))


def told(contacts, gaps, bottoms):
    """The labels of things 2, 3, …, 100 mm tall, that weigh 10 N.

    A contact is (first, second, normal, force, height).
    """
    first, second, normals, forces, places = (np.array(column) for column in zip(*contacts, strict=True))
    positions = np.stack([np.zeros(len(places)), np.zeros(len(places)), places], axis=1)
    found = Contacts(first, second, normals, forces, np.zeros(len(places)), positions)
    borne = bearing(found, np.full(len(bottoms), 10.0))
    near = {(gap.a, gap.b): gap for gap in gaps}
    heights = np.array([(bottom, bottom + 0.1) for bottom in bottoms])
    return true_relations(borne, near, heights, range(2, 2 + len(bottoms)))


def standing(thing, weight=10.0):
    return (-1, thing, UP, (0, 0, weight), 0.0)


def test_a_box_on_a_box():
    truth = told([standing(0, 20.0), (0, 1, UP, (0, 0, 10.0), 0.1)], [Gap(0, 1, 0.002, 0.0, False)], [0.0, 0.1])
    assert truth == (PairLabel(2, 1, "on"), PairLabel(3, 1, "none"), PairLabel(3, 2, "on"))


def test_the_carried_thing_comes_first_whatever_the_order():
    truth = told(
        [standing(1, 20.0), (0, 1, (0, 0, -1.0), (0, 0, -10.0), 0.1)], [Gap(0, 1, 0.002, 0.0, False)], [0.1, 0]
    )
    assert truth[2] == PairLabel(2, 3, "on")


@pytest.mark.parametrize(
    ("gap", "relation", "confidence"),
    [
        (0.005, "adjacent", 3),
        (0.014, "adjacent", 2),
        (0.02, "adjacent", 1),
        (0.025, "none", 1),
        (0.03, "none", 2),
        (0.05, "none", 3),
    ],
)
def test_beside_one_another_it_is_the_visible_gap_that_counts(gap, relation, confidence):
    truth = told([standing(0), standing(1)], [Gap(0, 1, gap, gap, True)], [0.0, 0.0])
    assert truth[2] == PairLabel(2, 3, relation, confidence)


def test_a_hidden_neighbour_is_doubtful_and_a_far_one_unlisted():
    hidden = told([standing(0), standing(1)], [Gap(0, 1, 0.06, 0.005, True)], [0.0, 0.0])
    far = told([standing(0), standing(1)], [Gap(0, 1, 0.081, 0.081, True)], [0.0, 0.0])
    assert hidden[2] == PairLabel(2, 3, "none", 1)
    assert len(far) == 2


@pytest.mark.parametrize(("seen", "confidence"), [(0.02, 3), (0.035, 1)])
def test_side_contact_without_load_is_adjacent_but_doubtful_where_it_cannot_be_seen(seen, confidence):
    contacts = [standing(0), standing(1), (0, 1, SIDE, (0, 0, 0), 0.05)]
    truth = told(contacts, [Gap(0, 1, seen, 0.001, True)], [0.0, 0.0])
    assert truth[2] == PairLabel(2, 3, "adjacent", confidence)


def test_on_a_foot_and_against_the_upright_is_both():
    contacts = [standing(0, 20.0), (0, 1, UP, (0, 0, 10.0), 0.03), (0, 1, SIDE, (0, 0, 0), 0.06)]
    assert told(contacts, [Gap(0, 1, 0.001, 0.0, True)], [0.0, 0.03])[2] == PairLabel(3, 2, "both")


def test_a_steeply_leaning_plank_is_both_by_its_load():
    # Normal 30° over the horizontal: no contact from below, but a fifth of the weight hangs on it.
    contacts = [standing(0, 12.0), standing(1, 8.0), (0, 1, SLANT, (3.4, 0, 2.0), 0.1)]
    assert told(contacts, [Gap(0, 1, 0.002, 0.0, True)], [0.0, 0.0])[2] == PairLabel(3, 2, "both")


def test_one_end_on_a_block_and_one_on_the_table_is_both_but_a_bridge_is_on():
    low = [standing(0, 15.0), standing(1, 5.0), (0, 1, UP, (0, 0, 5.0), 0.06)]
    assert told(low, [Gap(0, 1, 0.002, 0.0, False)], [0.0, 0.0])[2] == PairLabel(3, 2, "both")
    bridge = [standing(0, 15.0), standing(1, 15.0), (0, 2, UP, (0, 0, 5.0), 0.06), (1, 2, UP, (0, 0, 5.0), 0.06)]
    gaps = [Gap(0, 1, 0.07, 0.07, True), Gap(0, 2, 0.002, 0.0, False), Gap(1, 2, 0.002, 0.0, False)]
    truth = told(bridge, gaps, [0.0, 0.0, 0.06])
    assert [(p.a, p.b, p.relation) for p in truth[3:]] == [(2, 3, "none"), (4, 2, "on"), (4, 3, "on")]


@pytest.mark.parametrize(("force", "relation", "confidence"), [(0.3, "none", 2), (0.7, "on", 2), (5.0, "on", 3)])
def test_a_twentieth_of_the_weight_makes_on(force, relation, confidence):
    # Three contacts share the load: forces add up over a pair. The gap is not sideways, so nothing else is said.
    part = (0, 1, UP, (0, 0, force / 3), 0.1)
    truth = told([standing(0), part, part, part], [Gap(0, 1, 0.002, 0.0, False)], [0.0, 0.1])
    assert (truth[2].relation, truth[2].confidence) == (relation, confidence)


def test_a_contact_out_of_sight_is_probable_at_most():
    truth = told([standing(0, 20.0), (0, 1, UP, (0, 0, 10.0), 0.1)], [Gap(0, 1, 0.06, 0.0, False)], [0.0, 0.1])
    assert truth[2] == PairLabel(3, 2, "on", 2)
