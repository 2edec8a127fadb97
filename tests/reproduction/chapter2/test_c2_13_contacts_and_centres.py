"""C2.13: nodes by hand, and what contact points and centres tell of scenes made by hand."""

import pytest

from lifelore.core.relations import ADJACENT, NONE, ON
from reproduction.chapter2.c2_13_contacts_and_centres.run import ON_BLOCK, ON_POST, measure, rows, told_right
from reproduction.chapter2.scenes.tabletop_pairs import STANDARD

FIGURE = [[0, 0, 0.2, 12], [0, 0, 0.0, 2], [0.1, 0, 0.03, 3]]
"""The thesis's: three nodes, one of which is strong."""


def row(block, ball=((0, 0, 0.21, 9),), *, scene="s", relation=ON, centres=(0.0, 0.0, 0.1)):
    """A pair as a cell keeps it: A the ball, B the block; `centres` from the block's to the ball's."""
    contacts = {STANDARD: {"a": list(ball), "b": block}}
    return {"scene": scene, "relation": relation, "gap": 0.001, "contacts": contacts, "centres": list(centres)}


LESSONS = [
    *[
        row([[0, 0, 0.1, 9]], [[0.01, 0, 0.1, 9]], scene=f"b{k}", relation=ADJACENT, centres=(0.1, 0, 0))
        for k in range(4)
    ],
    *[row(FIGURE[:1], scene=f"o{k}") for k in range(4)],
]
UPON = row(FIGURE, scene="x")
"""As far apart as the lessons of *on*, in contact points and in centres."""
POST = row([[0, 0, 0.2, 9]], [[0.01, 0, 0.2, 9]], scene="y", relation=NONE)
"""Centres as far apart; the contact points are those of objects side by side."""


def test_centres_cannot_tell_a_post_and_contact_points_can():
    told = told_right({0: LESSONS, ON_BLOCK: [UPON], ON_POST: [POST]}, STANDARD)
    assert told == {
        "contacts": {ON_BLOCK: [True], ON_POST: [True]},
        "centres": {ON_BLOCK: [True], ON_POST: [False]},
    }


def test_measures_and_rows_by_hand():
    scenes = [UPON, row(FIGURE[:1], scene="x1"), row(FIGURE[1:], scene="x2")]
    results = [
        {"set": 0, "rows": LESSONS},
        {"set": ON_BLOCK, "rows": scenes, "examples": [{"example": "nodes"}]},
        {"set": ON_POST, "rows": [POST], "examples": []},
    ]
    found = measure({}, results)
    assert found["rank_of_three_nodes"].value == pytest.approx((0.5 + 1 + 1) / 3)
    assert found["topmost_alone_remains"].value == pytest.approx(2 / 3)
    assert (found["on_by_contacts"].value, found["on_by_contacts"].n) == (1, 3)
    assert (found["told_by_centres"].value, found["told_by_centres"].n) == (0.75, 4)
    assert rows({}, results) == [{"example": "nodes"}]
