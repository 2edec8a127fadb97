"""Compound relations: by hand, against a plain twin, and the thesis's definitions with what refutes them."""

from itertools import permutations

import networkx as nx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.relations import CORE_RELATIONS
from lifelore.perception.reasoning.compound_relations import compound_relations
from lifelore.perception.reasoning.fact import Fact
from lifelore.perception.relations.relation import Relation


def said(*rows):
    return [Relation(a, b, name, 1.0, 0.0) for a, b, name in rows]


def facts(rows, **options):
    return {str(fact) for fact in compound_relations(said(*rows), **options)}


def test_between_as_the_thesis_proposes_holds_at_a_corner_too():
    # §5.2: "two different adjacent relationships". 3 is the corner of an L of three boxes: nothing is between.
    assert "between(3, 2, 4)" in facts([(2, 3, "adjacent"), (3, 4, "adjacent")])
    # And in a ring of three that all touch, each is "between" the other two.
    ring = facts([(2, 3, "adjacent"), (3, 4, "adjacent"), (2, 4, "adjacent")])
    assert {"between(3, 2, 4)", "between(2, 3, 4)", "between(4, 2, 3)"} <= ring


def test_in_as_the_thesis_proposes_holds_of_a_leaning_plank_and_not_of_a_ball_in_a_bowl():
    # §5.2: "on as well as adjacent". A plank that leans on a box is both; a ball in a wide bowl is only on it.
    assert "in(3, 2)" in facts([(3, 2, "both"), (3, 1, "on")])
    assert "in(3, 2)" in facts([(3, 2, "on"), (2, 3, "adjacent")])
    assert not any(fact.startswith("in(") for fact in facts([(3, 2, "on")]))


def test_nothing_is_clear_by_words_of_ones_own():
    assert facts([(3, 2, "rests_on"), (2, 1, "on")]) == set()
    assert facts([(2, 1, "on"), (2, 3, "none")]) == {"clear(2)", "clear(3)"}


def plain_twin(rows, things):
    """The table of the module's head, read literally."""
    on = {(r.a, r.b) for r in rows if r.relation in ("on", "both")}
    beside = {pair for r in rows if r.relation in ("adjacent", "both") for pair in ((r.a, r.b), (r.b, r.a))}
    reach = nx.transitive_closure(nx.DiGraph([(b, a) for a, b in on if b in things]), reflexive=False)
    found = {Fact("clear", (a,)) for a in things if not any((b, a) in on for b in things | {1})}
    found |= {Fact("supports*", (a, b)) for a, b in reach.edges if a != b and a in things}
    found |= {Fact("in", (a, b)) for a, b in on & beside if b in things}
    for a, b, c in permutations(things, 3):
        if (a, b) in on and (b, c) in on:
            found.add(Fact("stacked", (a, b, c)))
        if (a, b) in beside and (b, c) in beside and a < c:
            found.add(Fact("between", (b, a, c)))
    return tuple(sorted(found))


@pytest.mark.slow
@settings(max_examples=80, deadline=None)
@given(st.lists(st.tuples(st.integers(2, 6), st.integers(1, 6), st.sampled_from(CORE_RELATIONS)), max_size=10))
def test_facts_are_those_of_the_plain_twin(triples):
    rows = said(*[(a, b, name) for a, b, name in triples if a != b])
    assert compound_relations(rows, [2, 7]) == plain_twin(
        rows, {2, 7} | {x for r in rows for x in (r.a, r.b)} - {1}
    )
