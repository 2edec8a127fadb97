"""The most likely consistent scene: by hand, against enumeration, and as properties."""

import math
import os
from itertools import product
from pathlib import Path

import networkx as nx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core import InputError, stream
from lifelore.core.relations import CORE_RELATIONS
from lifelore.perception.reasoning.label_distribution import LabelDistribution, label_distributions, relation_label
from lifelore.perception.reasoning.scene_logic import alternatives, most_likely_scene
from lifelore.perception.reasoning.second_support import LONE_LEAN
from lifelore.perception.relations.relation import PairBelief, Relation
from lifelore.perception.relations.relation_truth import read_relations

TABLE = 1
TRUTH = Path(os.environ.get("LIFELORE_DATA", "data")) / "osd" / "relations.csv"


def said(*rows):
    return [Relation(a, b, name, confidence, 0.0) for a, b, name, confidence in rows]


def plain(relations):
    return {(r.relation, r.a, r.b) for r in relations if r.relation != "none"}


def test_the_weakest_link_of_a_circle_is_given_up():
    scene = most_likely_scene(said((2, 3, "on", 0.9), (3, 4, "on", 0.8), (4, 2, "on", 0.3)))
    assert plain(scene.relations) == {("on", 2, 3), ("on", 3, 4), ("on", 4, TABLE)}
    assert scene.optimal


def test_what_no_object_carries_stands_on_the_table():
    scene = most_likely_scene(said((3, 2, "on", 0.7), (3, 4, "adjacent", 0.6)), objects=[5])
    table = {r.a: r.confidence for r in scene.relations if r.b == TABLE}
    assert set(table) == {2, 4, 5}
    # Of the mass not given to adjacent(3, 4), two labels of five carry 4: on(4, 3) and both(4, 3).
    assert table[4] == pytest.approx(1 - 0.4 * 2 / 5)
    assert table[5] == 1.0


def test_nothing_hangs_in_the_air():
    # 3 is judged to be off the table (0.6) and beside 2 (0.7, on it 0.25): standing after all costs ln(0.6 / 0.4),
    # resting on 2 costs ln(0.7 / 0.25).
    rows = said((3, TABLE, "none", 0.6), (3, TABLE, "on", 0.4), (2, 3, "adjacent", 0.7), (3, 2, "on", 0.25))
    scene = most_likely_scene(rows)
    assert plain(scene.relations) == {("adjacent", 2, 3), ("on", 3, TABLE), ("on", 2, TABLE)}
    surer = said((3, TABLE, "none", 0.9), (3, TABLE, "on", 0.1), (2, 3, "adjacent", 0.7), (3, 2, "on", 0.25))
    assert ("on", 3, 2) in plain(most_likely_scene(surer).relations)


def test_a_circle_of_equals_keeps_the_pairs_of_lowest_numbers():
    circle = said((2, 3, "on", 0.8), (3, 4, "on", 0.8), (4, 2, "on", 0.8))
    assert plain(most_likely_scene(circle).relations) == {("on", 2, 3), ("on", 4, 2), ("on", 3, TABLE)}
    assert most_likely_scene(circle[::-1]) == most_likely_scene(circle)


def test_a_consistent_scene_is_left_alone():
    rows = said((2, TABLE, "on", 0.9), (3, 2, "both", 0.5), (3, TABLE, "on", 0.6), (2, 4, "none", 0.4))
    scene = most_likely_scene(rows)
    assert set(rows) <= set(scene.relations)


LEANING = said((2, TABLE, "on", 0.9), (3, TABLE, "none", 0.9), (3, 2, "both", 0.6), (3, 2, "on", 0.3))
"""3 is off the table and leans on 2 alone, or rests on it: ln(0.6 / 0.3) is less than `LONE_LEAN`."""


def test_what_leans_on_one_object_alone_rests_on_it():
    scene = most_likely_scene(LEANING)
    assert ("on", 3, 2) in plain(scene.relations)
    assert scene.relations[0].confidence == 0.3


@pytest.mark.parametrize(
    "support",
    [said((3, 4, "on", 0.8), (4, TABLE, "on", 0.9)), said((3, TABLE, "on", 0.95))],
    ids=["an object", "the table"],
)
def test_a_second_support_lets_it_lean(support):
    rows = [row for row in LEANING if {(row.a, row.b)} != {(s.a, s.b) for s in support}]
    scene = most_likely_scene([*rows, *support])
    assert ("both", 3, 2) in plain(scene.relations)
    assert scene.relations[0].confidence == 0.6


def test_a_side_face_lets_it_lean_and_so_does_sureness():
    assert ("both", 3, 2) in plain(most_likely_scene(LEANING, beside={frozenset((2, 3))}).relations)
    sure = said((2, TABLE, "on", 0.9), (3, TABLE, "none", 0.9), (3, 2, "both", 0.97), (3, 2, "on", 0.03))
    assert ("both", 3, 2) in plain(most_likely_scene(sure).relations)


def test_labels_of_other_vocabularies_pass_unchanged():
    odd = Relation(2, 3, "left_of", 0.4, 0.1)
    assert odd in most_likely_scene([odd, *said((2, 3, "on", 0.9))]).relations


def test_what_a_pair_leaves_of_one_is_shared_alike():
    labels = LabelDistribution.from_candidates(said((3, 2, "on", 0.5), (2, 3, "adjacent", 0.3)))
    shares = dict(zip(labels.labels, labels.probabilities, strict=True))
    assert shares[("on", 3, 2)] == 0.5
    assert shares[("none", 2, 3)] == pytest.approx(0.05)
    assert sum(shares.values()) == pytest.approx(1)
    over = LabelDistribution.from_candidates(said((3, 2, "on", 1.0), (2, 3, "on", 1.0)))
    assert over.probabilities[over.likeliest] == 0.5


def test_beliefs_of_a_classifier_are_candidates():
    belief = PairBelief(
        2, 3, 0.01, {"on": 0.1, "~on": 0.6, "adjacent": 0.2, "both": 0.0, "~both": 0.0, "none": 0.1}
    )
    scene = most_likely_scene(alternatives([belief]))
    assert plain(scene.relations) == {("on", 3, 2), ("on", 2, TABLE)}
    assert scene.relations[0].gap == 0.01


def brute_force(rows, things):
    """Least loss with lone leans over every labelling that obeys the rules; unjudged objects may use the table."""
    beliefs = label_distributions(rows)
    judged = {belief.pair[0] for belief in beliefs if belief.pair[1] == TABLE}
    least = math.inf
    for picked in product(*(range(len(belief.labels)) for belief in beliefs)):
        labels = [belief.labels[k] for belief, k in zip(beliefs, picked, strict=True)]
        rests = nx.DiGraph([(a, b) for name, a, b in labels if name in ("on", "both")])
        resting = all(thing in rests and rests.out_degree(thing) for thing in things if thing in judged)
        if resting and nx.is_directed_acyclic_graph(rests):
            loss = sum(b.cost(k) - b.cost(b.likeliest) for b, k in zip(beliefs, picked, strict=True))
            least = min(least, loss + lone_leans(labels, judged) * LONE_LEAN)
    return least


def given_up(scene, beliefs):
    """Nats of log likelihood that a scene gives up against the likeliest label of each pair."""
    decided = [relation_label(relation) for relation in scene.relations[: len(beliefs)]]
    return sum(
        b.cost(b.labels.index(label)) - b.cost(b.likeliest) for b, label in zip(beliefs, decided, strict=True)
    )


def is_consistent(relations, things=()):
    """Whether each pair has one relation, each object rests on something, none on itself, the table on nothing."""
    pairs = [frozenset((r.a, r.b)) for r in relations]
    rests = nx.DiGraph([(r.a, r.b) for r in relations if r.relation in ("on", "both")])
    resting = {thing for thing in rests if rests.out_degree(thing)}
    objects = {*things, *(end for pair in pairs for end in pair)} - {TABLE}
    return len(set(pairs)) == len(pairs) and nx.is_directed_acyclic_graph(rests) and resting == objects


def lone_leans(labels, judged):
    """Number of objects that lean on another and rest on nothing else."""
    rests = {(a, b) for name, a, b in labels if name in ("on", "both")}
    leaning = [(a, b) for name, a, b in labels if name == "both" and b != TABLE and a in judged]
    return sum(all(c == b for a_, c in rests if a_ == a) for a, b in leaning)


@st.composite
def perceived(draw, n_things=4, most_pairs=4):
    pairs = st.tuples(*[st.integers(TABLE, n_things + 1)] * 2).filter(lambda p: p[0] != p[1] and p[0] != TABLE)
    label = st.sampled_from(CORE_RELATIONS)
    rows = draw(
        st.lists(st.tuples(pairs, label, st.integers(0, 20)), max_size=most_pairs, unique_by=lambda r: r[0])
    )
    return said(*((a, b, name, tenth / 20) for (a, b), name, tenth in rows))


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(perceived())
def test_nothing_likelier_is_consistent(rows):
    things = {label for r in rows for label in (r.a, r.b)} - {TABLE}
    scene = most_likely_scene(rows)
    beliefs = label_distributions(rows)
    judged = {belief.pair[0] for belief in beliefs if belief.pair[1] == TABLE}
    decided = [relation_label(relation) for relation in scene.relations[: len(beliefs)]]
    loss = given_up(scene, beliefs) + lone_leans(decided, judged) * LONE_LEAN
    # Costs are rounded to 1 / SCALE of a nat, at most half of one a label and pair.
    assert loss == pytest.approx(brute_force(rows, things), abs=0.001 * len(rows) + 1e-9)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(perceived(n_things=8, most_pairs=16), st.randoms(use_true_random=False))
def test_the_answer_is_consistent_whatever_came_and_in_whatever_order(rows, random):
    scene = most_likely_scene(rows, objects=[2, 3])
    assert is_consistent(scene.relations, {2, 3} | {r.a for r in rows})
    assert scene.optimal
    shuffled = list(rows)
    random.shuffle(shuffled)
    assert most_likely_scene(shuffled, objects=[3, 2]) == scene
    # A consistent scene, seen again, stays as it is.
    again = most_likely_scene(
        [Relation(r.a, r.b, r.relation, 0.9, r.gap) for r in scene.relations], objects=[2, 3]
    )
    assert plain(again.relations) == plain(scene.relations)


def sixty_objects(seed):
    """Some 150 pairs, each said to be *on* in a random direction: dozens of circles, far worse than perception."""
    rng = stream(seed, "sixty")
    pairs = {tuple(sorted(pair)): pair for pair in rng.integers(2, 62, (160, 2)).tolist() if pair[0] != pair[1]}
    rows = [Relation(a, b, "on", float(rng.random()), 0.0) for a, b in pairs.values()]
    return rows + [Relation(thing, TABLE, "on", float(rng.random()), 0.0) for thing in range(2, 62)]


def test_sixty_objects_that_contradict_each_other_are_settled_with_proof():
    scene = most_likely_scene(sixty_objects(0))
    assert scene.optimal
    assert is_consistent(scene.relations, range(2, 62))


def test_when_the_bound_runs_out_the_scene_is_consistent_and_says_so():
    scene = most_likely_scene(sixty_objects(0), most_conflicts=1)
    assert not scene.optimal
    assert is_consistent(scene.relations, range(2, 62))
    beliefs = label_distributions(sixty_objects(0))
    assert given_up(scene, beliefs) >= given_up(most_likely_scene(sixty_objects(0)), beliefs)


def test_wrong_input_is_refused():
    with pytest.raises(InputError, match="confidence"):
        most_likely_scene(said((2, 3, "on", 1.5)))
    with pytest.raises(InputError, match="two objects"):
        most_likely_scene(said((2, 2, "on", 0.5)))
    with pytest.raises(InputError, match="most_conflicts"):
        most_likely_scene([], most_conflicts=0)
    assert most_likely_scene([]).relations == ()


@pytest.mark.skipif(not TRUTH.exists(), reason="needs LIFELORE_DATA/osd")
def test_the_truth_of_every_real_scene_is_consistent():
    for name, labels in read_relations(TRUTH).items():
        assert is_consistent(labels), name
