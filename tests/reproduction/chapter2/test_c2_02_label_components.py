"""C2.2: the two components by hand, splits that keep scenes on one side, and pairs without a displacement."""

import numpy as np
import pytest

from lifelore.core.relations import ADJACENT, BOTH, NONE, ON
from reproduction.chapter2.c2_02_label_components.run import COMPONENTS, component_answers, split_answers
from reproduction.chapter2.scenes.tabletop_pairs import KERNEL_NAMES
from reproduction.chapter2.scoring.pair_validation import Reading
from reproduction.engine.estimates import exact_share
from reproduction.engine.registry import claim_of

SETTINGS = {"pairs": 12, "test": 3, "splits": 20, "agree": 0.75}
NOBODY = np.array([], str)


def at(scene, relation, *places, support=9) -> dict:
    """A row with displacements along x, the same under every kernel."""
    contacts = {"a": [[x, 0, 0, support] for x in places], "b": [[0, 0, 0, 9]]}
    return {"scene": scene, "relation": relation, "gap": 0.01, "contacts": dict.fromkeys(KERNEL_NAMES, contacts)}


def apart(prefix) -> list[dict]:
    """Six *on* near 0 and six *adjacent* near 100: three of either are left in training at the worst."""
    return [at(f"{prefix}{n}", ON, n) for n in range(6)] + [
        at(f"{prefix}b{n}", ADJACENT, 100 + n) for n in range(6)
    ]


def test_components_by_hand():
    truth = np.array([ON, BOTH, ADJACENT, ADJACENT])
    shares = np.array([(0.75, 0.25, 0, 0), (0.5, 0.5, 0, 0), (0.5, 0, 0.5, 0), (0, 0.25, 0, 0.75)])
    found = component_answers(shares, truth, NOBODY, 0.75)
    # on: 75, 50, 100 and 0 % have it; said of the first three, true of two. The second is in doubt.
    assert [found[f"on_{key}"] for key in ("right", "less_majority", "agreement")] == [0.75, 0.25, 0.75]
    # adjacent: 25, 50, 50 and 25 %; said of the second and third, true of the last three. These two are in doubt.
    assert [found[f"adjacent_{key}"] for key in ("right", "less_majority", "agreement")] == [0.75, 0, 0.5]
    assert found["agreement_on_less_adjacent"] == 0.25


@pytest.mark.parametrize(
    ("votes", "agree", "on", "adjacent"),
    [
        ((0.75, 0.25, 0, 0), 0.75, 1, 1),  # three of four do
        ((0.75, 0.25, 0, 0), 0.76, 0, 0),
        ((0.5, 0.25, 0.25, 0), 0.75, 1, 0),  # both counts for either component
        ((0.25, 0.25, 0, 0.5), 0.75, 1, 1),  # agreement that it is not there
        ((0.5, 0, 0, 0.5), 0.75, 0, 1),
        ((2 / 3, 1 / 3, 0, 0), 2 / 3, 1, 1),
    ],
)
def test_agreement_is_with_what_is_said(votes, agree, on, adjacent):
    found = component_answers(np.array([votes], float), np.array([ON]), NOBODY, agree)
    assert (found["on_agreement"], found["adjacent_agreement"]) == (on, adjacent)


def test_a_lost_pair_is_one_wrong_relationship_of_either_component():
    found = component_answers(np.array([[1.0, 0, 0, 0]] * 3), np.array([ON] * 3), np.array([NONE]), 0.75)
    assert [found[f"{name}_right"] for name in COMPONENTS] == [0.75, 0.75]
    # *on* is true of three of four; *adjacent* of none, lost or not.
    assert [found[f"{name}_less_majority"] for name in COMPONENTS] == [0, -0.25]
    assert found["on_agreement"] == 0.75


def test_clear_clusters_are_right_in_every_split():
    found = split_answers(SETTINGS, apart("s"), Reading(), 20, "0")
    for name in COMPONENTS:
        assert (found[f"{name}_right"], found[f"{name}_agreement"]) == (1, 1)
        # Of three told the more frequent value holds two or three.
        assert 0 < found[f"{name}_less_majority"] <= 1 / 3


def test_agreement_is_asked_of_the_exact_intervals_of_28_and_18_of_49():
    asked = {one.measure: one.bound for one in claim_of("C2.2").statements}
    for name, agreed in (("on_agreement", 28), ("adjacent_agreement", 18)):
        low, high = exact_share([True] * agreed + [False] * (49 - agreed)).ci95
        assert asked[name] == (round(low, 3), round(high, 3))
