"""The region calculus: who touches whom, by hand, and one relation for every pair."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.core.relations import CORE_RELATIONS
from lifelore.perception.reasoning.region_calculus import region_relations
from lifelore.perception.relations.relation import Relation


def test_what_rests_touches_and_neighbours_touch_when_they_look_as_near():
    rows = [
        Relation(2, 1, "on", 1.0, 0.03),
        Relation(3, 2, "both", 1.0, 0.02),
        Relation(3, 4, "adjacent", 1.0, 0.004),
        Relation(4, 5, "adjacent", 1.0, 0.0041),
        Relation(2, 4, "none", 1.0, 0.001),
    ]
    facts = {str(fact) for fact in region_relations(rows)}
    assert {fact for fact in facts if fact.startswith("ec")} == {"ec(table, 2)", "ec(2, 3)", "ec(3, 4)"}
    assert "ec(4, 5)" in {str(fact) for fact in region_relations(rows, touching=0.005)}
    assert "dc(2, 4)" in facts


@pytest.mark.slow
@given(
    st.lists(st.tuples(st.integers(2, 6), st.integers(1, 6), st.sampled_from(CORE_RELATIONS), st.floats(0, 1))),
    st.sets(st.integers(2, 9)),
)
def test_every_pair_has_exactly_one_relation(rows, objects):
    relations = [Relation(a, b, name, 1.0, gap) for a, b, name, gap in rows if a != b]
    facts = region_relations(relations, objects)
    n = len({1, *objects, *(x for r in relations for x in (r.a, r.b))})
    assert len({fact.arguments for fact in facts}) == len(facts) == n * (n - 1) // 2
    assert all(fact.arguments[0] < fact.arguments[1] and fact.name in ("dc", "ec") for fact in facts)


def test_words_of_ones_own_may_mean_touching():
    rows = [Relation(3, 2, "rests_on", 1.0, 0.0), Relation(2, 1, "on", 1.0, 0.0)]
    assert [str(fact) for fact in region_relations(rows, [4])] == ["ec(table, 2)"]
