"""The benchmark of classes, small: whose places they are, what knowledge tells, and its rows."""

import numpy as np
import pytest

from benchmarks import bench
from benchmarks.action import advice_classes as case
from lifelore.domains.worlds import make_world


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(case, "WORLDS", {"mazes": "advice"})
    monkeypatch.setattr(case, "ERRANDS", 4)
    monkeypatch.setattr(case, "EXPERT_WALKS", 8)
    monkeypatch.setattr(case, "KNOWLEDGE", (0.0, 0.5))
    monkeypatch.setattr(case, "MOST_STEPS", 800)


def test_each_class_has_places_of_its_own(small):
    classes = case.places_of(make_world("advice", seed=1), "mazes", 1)
    goals = {name: {place.found.goal for place in places} for name, places in classes.items()}
    assert [len(goals[name]) for name in case.CLASSES] == [4, 4]
    assert not goals["staff"] & goals["visitor"]
    for places in classes.values():
        for place in places:
            assert place.model.goals == (place.found.goal,)
            assert place.found.steps[place.found.goal] == 0


def test_rows_and_goals(small):
    document = bench("advice_classes", repeats=3)
    rows = {row["name"]: row for row in document["rows"]}
    assert len(rows) == len(document["rows"]) == 2 * ((4 + 2) + (6 + 4)) + 4
    one, inferred = (f"mazes, knowledge 0.5, {case.LIMITED}, {way}" for way in (case.ONE, case.INFERRED))
    ratio = rows[f"steps beside one prior, {inferred}"]["value"]
    assert ratio == pytest.approx(rows[f"steps, {inferred}"]["value"] / rows[f"steps, {one}"]["value"])
    for settings in case.SETTINGS:
        # Without advice nothing depends on the settings, and it takes longer.
        alone = rows[f"steps, mazes, knowledge 0, {settings}, {case.NONE}"]["value"]
        assert alone == rows[f"steps, mazes, knowledge 0, {case.LIMITED}, {case.NONE}"]["value"]
        assert alone > rows[f"steps, mazes, knowledge 0, {settings}, {case.SHOWN}"]["value"]
    named = [
        rows[f"class named rightly by 30 steps without advice, mazes, knowledge {k}, {case.APART}"]["value"]
        for k in ("0", "0.5")
    ]
    # 24 walks: knowledge of half of the steps tells more than none.
    assert named[1] > named[0]
    assert [goal["met"] for goal in document["goals"]] == [None]


def test_an_advisor_names_the_class_of_its_own_expert(small):
    world = make_world("advice", seed=2)
    classes = case.places_of(world, "mazes", 2)
    known = case.class_advisors(world, classes)
    for name, places in classes.items():
        place = places[0]
        far = int(np.argmax(place.found.steps))
        walk = case.expert_walk(world, place.found, far, np.random.default_rng(0))
        states = case.Walk(walk.states[:-1], walk.actions, *[np.zeros(0)] * 3, reached=True, reward=0.0)
        assert {case._named(advisor, states, 60) for advisor in known.values()} == {name}
