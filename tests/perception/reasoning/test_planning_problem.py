"""PDDL: the initial state by hand, and names that PDDL takes."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.perception.reasoning.planning_problem import RESERVED, pddl_names, planning_problem
from lifelore.perception.relations.relation import Relation


def atoms(text):
    return re.findall(r"\(([a-z-]+(?: [a-z0-9_-]+)*)\)", text.split(":init")[1].split("(:goal")[0])


def test_the_initial_state_by_hand():
    rows = [
        (2, 1, "on"),
        (3, 2, "both"),
        (3, 1, "on"),
        (2, 4, "adjacent"),
        (4, 1, "on"),
        (3, 4, "none"),
        (5, 1, "on"),
    ]
    text = planning_problem([Relation(a, b, name, 1.0, 0.0) for a, b, name in rows], [5])
    assert "(:objects o2 o3 o4 o5 - thing)" in text
    assert atoms(text) == [
        "hand-empty",
        "adjacent o2 o3",
        "adjacent o2 o4",
        "adjacent o3 o2",
        "adjacent o4 o2",
        "clear o3",
        "clear o4",
        "clear o5",
        "on o3 o2",
        "on-table o2",
        "on-table o3",
        "on-table o4",
        "on-table o5",
    ]


def test_what_cannot_be_planned_with_is_named():
    own = [Relation(3, 7, "rests_on", 1.0, 0.0), Relation(7, 1, "rests_on", 1.0, 0.0)]
    with pytest.raises(InputError, match="must be on, adjacent, both, none, got rests_on"):
        planning_problem(own)
    with pytest.raises(InputError, match="of 3, 5 nothing says so"):
        planning_problem([Relation(2, 1, "on", 1.0, 0.0), Relation(2, 3, "adjacent", 1.0, 0.0)], [5])
    assert "(:init\n    (hand-empty))" in planning_problem([])


def test_names_given_are_made_valid_and_kept_apart():
    names = {2: "Mug (blue)", 3: "mug [blue]", 4: "7up", 5: "on", 6: "é"}
    called = pddl_names([2, 3, 4, 5, 6, 7], names)
    assert list(called.values()) == ["mug__blue_", "mug__blue__3", "o7up", "on_5", "o_", "o7"]
    with pytest.raises(InputError, match="names"):
        pddl_names([2], {3: "cup"})


@pytest.mark.slow
@settings(deadline=None)
@given(st.dictionaries(st.integers(2, 20), st.text(max_size=12)))
def test_every_name_is_one_of_pddl_and_no_two_are_alike(names):
    called = pddl_names(sorted({*names, 21}), names)
    assert all(re.fullmatch(r"[a-z][a-z0-9_-]*", name) for name in called.values())
    assert len(set(called.values())) == len(called)
    assert not RESERVED & set(called.values())
