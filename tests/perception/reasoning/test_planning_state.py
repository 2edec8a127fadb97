"""States to plan in: probabilities by hand, and what stays unknown."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.core.relations import CORE_RELATIONS
from lifelore.perception.reasoning.fact import Fact
from lifelore.perception.reasoning.label_distribution import label_distributions
from lifelore.perception.reasoning.planning_state import planning_state, scene_state
from lifelore.perception.reasoning.scene_logic import alternatives, most_likely_scene
from lifelore.perception.relations.relation import PairBelief, Relation

# 3 rests on 2 almost surely (on 0.5, both 0.4); beside it with 0.45.
PAIR = PairBelief(2, 3, 0.0, {"~on": 0.5, "~both": 0.4, "adjacent": 0.05, "none": 0.05})
TABLE_PAIRS = [Relation(2, 1, "on", 0.9, 0.0), Relation(3, 1, "none", 0.8, 0.0)]


def state_at(least, pair=PAIR, relation="on"):
    beliefs = label_distributions([*alternatives([pair]), *TABLE_PAIRS])
    return planning_state([Relation(3, 2, relation, 0.5, 0.0), *TABLE_PAIRS], (), least, beliefs)


def test_the_probability_of_resting_adds_on_and_both():
    state = state_at(0.85)
    assert Fact("on", (3, 2)) in state.stated
    assert Fact("clear", (3,)) in state.stated
    assert state.may_cover == {}
    (unknown,) = state_at(0.85, relation="both").unknown
    assert (unknown.fact, round(unknown.probability, 4)) == (Fact("adjacent", (2, 3)), 0.45)


def test_what_another_object_may_cover_is_not_clear():
    unsure = PairBelief(2, 3, 0.0, {"adjacent": 0.7, "~on": 0.3})
    state = state_at(0.8, unsure, "adjacent")
    by_fact = {one.fact: one for one in state.unknown}
    assert round(by_fact[Fact("clear", (2,))].probability, 3) == 0.7
    assert by_fact[Fact("adjacent", (2, 3))].reason == "doubtful"
    assert Fact("clear", (3,)) in state.stated
    assert state.may_cover == {(3, 2): "doubtful"}
    assert state.probability[Fact("clear", (2,))] == pytest.approx(1, abs=1e-5)  # once 3 is taken away


def test_as_many_objects_may_cover_another_one_as_its_clearness_takes():
    """3, 4 and 5 rest on 2 with 0.3, 0.2 and 0.1: 0.7 · 0.8 · 0.9 = 0.504, 0.8 · 0.9 = 0.72, 0.9."""
    beside = [PairBelief(2, x, 0.0, {"adjacent": 1 - p, "~on": p}) for x, p in ((3, 0.3), (4, 0.2), (5, 0.1))]
    beliefs = label_distributions(alternatives(beside))
    scene = [Relation(2, x, "adjacent", 0.5, 0.0) for x in (3, 4, 5)]
    for least, first in ((0.5, []), (0.6, [3]), (0.8, [3, 4]), (0.95, [3, 4, 5])):
        assert sorted(planning_state(scene, (), least, beliefs).may_cover) == [(x, 2) for x in first]


def test_a_doubtful_object_on_it_leaves_an_object_covered_perhaps():
    state = state_at(0.95)
    assert Fact("on", (3, 2)) not in state.stated
    assert not any(fact == Fact("clear", (2,)) for fact in state.stated)
    assert state.may_cover == {(3, 2): "doubtful"}


def test_a_threshold_is_a_probability():
    for least in (-0.1, 1.1, float("nan")):
        with pytest.raises(InputError, match="min_confidence must be a probability"):
            planning_state([], (), least)


@settings(deadline=None, max_examples=60)
@given(
    st.lists(
        st.tuples(st.sampled_from(CORE_RELATIONS), st.integers(1, 5), st.integers(2, 6), st.floats(0, 1)),
        max_size=8,
    ),
    st.floats(0, 1),
    st.floats(0, 1),
)
def test_a_higher_threshold_states_less(rows, first, second):
    candidates = [Relation(max(a, b), min(a, b), name, p, 0.0) for name, a, b, p in rows if a != b]
    scene = most_likely_scene(candidates).relations
    low, high = (planning_state(scene, (), least) for least in sorted((first, second)))
    assert set(high.stated) <= set(low.stated)
    assert _to_take_first(low) <= _to_take_first(high)
    assert planning_state(scene).unknown == ()


def _to_take_first(state):
    on = {fact.arguments for fact in state.stated if fact.name == "on" and fact.arguments[1] != 1}
    return on | set(state.may_cover)


def test_a_top_that_a_nearer_object_hides_is_unknown(make_scene, box):
    """A camera 1 m away at 0.5 m height; a tall box before a low one hides its top, one beside it does not."""
    camera = np.array([0.0, -1.0, 0.5])
    low = box([0, 0, 0], [0.1, 0.1, 0.05])
    rows = [(2, 1, "on"), (3, 1, "on")]
    for tall, hidden in (([0, -0.1, 0], True), ([0.2, 0, 0], False), ([0, 0.2, 0], False)):
        high = box(tall, np.add(tall, [0.1, 0.05, 0.3]))
        state = scene_state(make_scene({2: low, 3: high}, relations=rows, camera=camera))
        assert (Fact("clear", (2,)) not in state.stated) == hidden
        assert [one.reason for one in state.unknown] == ["hidden"] * hidden
        assert state.may_cover == ({(3, 2): "hidden"} if hidden else {})
        assert Fact("clear", (3,)) in state.stated
        below = scene_state(make_scene({2: low, 3: high}, relations=rows, camera=np.array([0.0, -1.0, 0.0])))
        assert below.unknown == ()
    # Without a camera nothing is known of what is hidden, and what carries an object is not clear anyway.
    assert scene_state(make_scene({2: low, 3: high}, relations=rows)).unknown == ()
    on = [(2, 1, "on"), (3, 2, "on")]
    above = box([0.02, 0.02, 0.05], [0.08, 0.08, 0.3])
    assert scene_state(make_scene({2: low, 3: above}, relations=on, camera=camera)).unknown == ()
