"""A real planner on PDDL of real scenes; every plan is replayed by a simulator of ours."""

import csv
import os
import sys
import warnings
from dataclasses import replace
from pathlib import Path

import pytest

from lifelore.bridges.planner import solve
from lifelore.core.errors import InputError, LifeloreError, MissingExtraError
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.reasoning.planning_domain import DOMAIN, planning_domain
from lifelore.perception.reasoning.planning_goal import read_goal
from lifelore.perception.reasoning.planning_problem import problem_text, scene_problem
from lifelore.perception.reasoning.planning_state import planning_state
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.words import Words
from lifelore.perception.scene_perception import perceived_scene
from lifelore.perception.segmentation.table_frame import to_scene

pytestmark = pytest.mark.planning

TRUTH = Path(os.environ.get("LIFELORE_DATA", "nowhere")) / "osd" / "relations.csv"
PILE = [Relation(a, b, "on", 1.0, 0.0) for a, b in ((2, 1), (3, 2), (4, 3), (5, 1))]


def pile_problem(goal="(and )"):
    """The problem of `PILE`."""
    state = planning_state(PILE)
    return problem_text(state, goal)


def replay(plan, relations, things):
    """On, on-table and holding after the plan; an assertion fails where a step may not be taken."""
    on = {(f"o{r.a}", f"o{r.b}") for r in relations if r.relation in ("on", "both") and r.b != 1}
    table = {f"o{r.a}" for r in relations if r.relation in ("on", "both") and r.b == 1}
    beside = {
        frozenset((f"o{r.a}", f"o{r.b}")) for r in relations if r.relation in ("adjacent", "both") and r.b != 1
    }
    held = None
    for step in plan:
        a, *rest = step.arguments
        if step.action == "pick-up":
            assert held is None
            assert not any(below == a for _, below in on)
            on, table, held = {pair for pair in on if pair[0] != a}, table - {a}, a
            beside = {pair for pair in beside if a not in pair}
            continue
        assert held == a
        held = None
        if step.action == "put-on":
            assert rest[0] != a
            assert not any(below == rest[0] for _, below in on)
            on.add((a, rest[0]))
        else:
            table.add(a)
            if step.action == "put-beside":
                assert rest[0] in table
                beside.add(frozenset((a, rest[0])))
    return on, table, held, beside


def real_scene(name):
    with TRUTH.open() as file:
        rows = [row for row in csv.DictReader(file) if row["scene"] == name]
    return [Relation(int(r["a"]), int(r["b"]), r["relation"], int(r["confidence"]) / 3, 0.0) for r in rows]


@pytest.mark.slow
def test_a_pile_is_turned_over():
    plan = solve(DOMAIN, pile_problem("(and (on o2 o3) (on o3 o4))"))
    on, table, held, _ = replay(plan, PILE, range(2, 6))
    assert on == {("o2", "o3"), ("o3", "o4")}
    assert {"o4", "o5"} <= table
    assert held is None
    assert str(plan[0]) == "(pick-up o4)"


@pytest.mark.slow
def test_a_goal_that_cannot_be_has_no_plan():
    assert solve(DOMAIN, pile_problem("(and (on o2 o3) (on o3 o2))")) is None


@pytest.mark.slow
@pytest.mark.skipif(not TRUTH.exists(), reason="needs LIFELORE_DATA/osd")
@pytest.mark.parametrize("name", ["learn22", "test47"])
def test_from_the_points_of_a_real_scene_to_a_plan(name):
    """The points as the camera saw them: what lies under an object in them is brought into the hand.

    The plan is replayed on the hand-made truth, so that it fails where perception is wrong, and it takes no step
    more than there are objects to put away.
    """
    scene = perceived_scene(to_scene(read_cloud(TRUTH.parent / f"{name}.pcd")))
    carriers = {r.b for r in scene.relations if r.relation == "on" and r.b != 1}
    bottom = min(carriers)
    truth = real_scene(name)
    above, grown = {bottom}, None
    while grown != above:
        grown, above = above, above | {r.a for r in truth if r.relation == "on" and r.b in above}
    plan = solve(DOMAIN, scene_problem(scene, 0.0, read_goal(f"holding(o{bottom})")))
    *_, held, _ = replay(plan, truth, scene.objects)
    assert held == f"o{bottom}"
    # One step for the last object, two for each above it: learn22 is a pile of three, in test47 two lie on o3.
    assert len(above) == 3
    assert plan is not None
    assert len(plan) == 5


@pytest.mark.slow
def test_words_of_a_user_are_planned_with():
    """A word ends when its object is taken away, and no action makes one hold."""
    words = Words(("left of", "near"), frozenset({"near"}))
    rows = [*PILE, Relation(4, 5, "near", 1.0, 0.0), Relation(2, 5, "left of", 1.0, 0.0)]
    state = planning_state(rows)

    def plan(goal):
        return solve(planning_domain(words), problem_text(state, goal, words))

    steps = plan("(and (on-table o4) (not (near o5 o4)) (left_of o2 o5))")
    assert steps is not None
    assert [str(step) for step in steps] == ["(pick-up o4)", "(put-on-table o4)"]
    assert plan("(near o3 o5)") is None


@pytest.mark.slow
def test_what_may_cover_an_object_is_taken_away_first():
    """2 carries 3, and 5 may rest on 2 or hides its top: 2 is fetched after both, and 3 alone."""
    state = replace(planning_state([*PILE[:2], PILE[3]]), may_cover={(5, 2): "hidden"})
    steps = solve(DOMAIN, problem_text(state, "(holding o2)")) or ()
    assert {str(step) for step in steps if step.action == "pick-up"} == {f"(pick-up o{n})" for n in (2, 3, 5)}
    assert str(steps[-1]) == "(pick-up o2)"
    assert len(solve(DOMAIN, problem_text(state, "(holding o3)")) or ()) == 1


@pytest.mark.slow
def test_objects_that_may_cover_each_other_are_not_planned_with():
    state = replace(planning_state([PILE[0], PILE[3]]), may_cover={(2, 5): "doubtful", (5, 2): "doubtful"})
    unclear = replace(state, stated=tuple(fact for fact in state.stated if fact.name != "clear"))
    assert solve(DOMAIN, problem_text(unclear, "(holding o2)")) is None


@pytest.mark.parametrize(
    ("domain", "problem"), [("(define", ""), (DOMAIN, "(define (problem x) (:domain nowhere"), ("", "")]
)
def test_what_is_no_pddl_is_refused(domain, problem):
    with pytest.raises(InputError, match="PDDL"):
        solve(domain, problem)


def test_without_the_library_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "unified_planning", None)
    with pytest.raises(MissingExtraError, match=r"lifelore\[planning\]"):
        solve(DOMAIN, pile_problem())


def test_timeout_must_be_a_time():
    with pytest.raises(InputError, match="timeout"):
        solve(DOMAIN, pile_problem(), timeout=0)


def test_an_engine_out_of_time_has_ended():
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        with pytest.raises(LifeloreError, match=r"no plan in 0\.02 s"):
            solve(DOMAIN, pile_problem("(on o2 o5)"), timeout=0.02)
    assert not [note.message for note in heard if "still running" in str(note.message)]
