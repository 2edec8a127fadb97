"""Relations between found objects, counted by hand."""

from lifelore.core.relations import PairLabel
from lifelore.perception.relations.relation import Relation
from reproduction.chapter2.scoring.segmented_relations import relation_counts

TRUTH = (
    PairLabel(3, 2, "on", 3),
    PairLabel(4, 5, "adjacent", 2),
    PairLabel(2, 4, "none", 3),
    PairLabel(5, 6, "on", 1),
    PairLabel(2, 1, "on", 3),
)
STANDS_FOR = {10: 2, 11: 3, 12: 4, 13: 5, 14: 6}


def counts(*perceived):
    found = relation_counts(TRUTH, [Relation(a, b, name, 1.0, 0.0) for name, a, b in perceived], STANDS_FOR)
    return found.right, found.perceived, found.true


def test_right_relations_in_their_direction():
    assert counts(("on", 11, 10), ("adjacent", 13, 12)) == (2, 2, 2)
    assert counts(("on", 10, 11)) == (0, 1, 2)


def test_wrong_relations():
    assert counts(("adjacent", 11, 10)) == (0, 1, 2)
    assert counts(("on", 10, 12)) == (0, 1, 2)
    # 20 stands for no object.
    assert counts(("on", 20, 10)) == (0, 1, 2)


def test_the_table_none_and_doubtful_labels_do_not_count():
    assert counts(("on", 10, 1), ("none", 11, 10), ("on", 13, 14)) == (0, 0, 2)
