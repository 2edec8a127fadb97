"""Facts of scenes: all of them in the core words, and with a user's own words only what was said."""

import numpy as np

from lifelore.perception.reasoning.fact import objects_without_support, words_outside_core
from lifelore.perception.reasoning.scene_facts import scene_facts
from lifelore.perception.relations.relation import Relation

POINT = np.zeros((1, 3))
THINGS = dict.fromkeys((2, 3, 7), POINT)


def said(scene):
    return [str(fact) for fact in scene_facts(scene)]


def test_core_words_give_every_fact(make_scene):
    scene = make_scene(THINGS, relations=[(3, 7, "on"), (7, 1, "on"), (2, 1, "on"), (2, 3, "none")])
    assert said(scene) == [
        "clear(2)",
        "clear(3)",
        "dc(table, 3)",
        "dc(2, 3)",
        "dc(2, 7)",
        "ec(table, 2)",
        "ec(table, 7)",
        "ec(3, 7)",
        "on(2, table)",
        "on(3, 7)",
        "on(7, table)",
        "supports*(7, 3)",
    ]


def test_of_a_users_own_words_nothing_is_derived(make_scene):
    scene = make_scene(THINGS, relations=[(3, 7, "rests_on"), (7, 1, "rests_on"), (2, 7, "beside")])
    assert said(scene) == ["beside(2, 7)", "rests_on(3, 7)", "rests_on(7, table)"]
    mixed = make_scene(THINGS, relations=[(3, 7, "on"), (7, 1, "on"), (2, 1, "on"), (2, 3, "beside")])
    assert {"beside(2, 3)", "on(3, 7)", "clear(2)", "clear(3)", "supports*(7, 3)"} <= set(said(mixed))
    assert "clear(7)" not in said(mixed)


def test_where_nothing_says_what_carries_a_thing_nothing_is_derived(make_scene):
    # A model of other words that found none of them but its "none", or nothing at all.
    assert said(make_scene(THINGS, relations=[(2, 3, "none")])) == []
    assert said(make_scene(THINGS)) == []
    assert said(make_scene(THINGS, relations=[(3, 7, "on"), (7, 1, "on")])) == ["on(3, 7)", "on(7, table)"]


def test_what_is_missing_by_hand():
    rows = [Relation(a, b, name, 1.0, 0.0) for a, b, name in ((2, 1, "on"), (3, 4, "both"), (4, 5, "under"))]
    assert words_outside_core(rows) == ("under",)
    assert objects_without_support(rows, [9]) == (4, 5, 9)
    assert objects_without_support([]) == ()
