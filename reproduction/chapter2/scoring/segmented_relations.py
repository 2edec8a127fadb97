"""Relations perceived between found objects, counted against the relations of the true objects.

A found object stands for the true object that it finds (IoU of at least 0.5). A relation is right if both ends
stand for true objects and the label of this pair has the same relation and direction. A relation of an object that
stands for nothing is wrong. Relations with the table, pairs labelled *none*, and labels below a confidence do not
count.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import NONE, SYMMETRIC, PairLabel
from lifelore.perception.relations.relation import Relation

LEAST_CONFIDENCE = 2


@dataclass(frozen=True)
class RelationCounts:
    """How many relations are right, how many were perceived, and how many are true."""

    right: int
    perceived: int
    true: int


def relation_counts(
    truth: Sequence[PairLabel], perceived: Sequence[Relation], stands_for: Mapping[int, int]
) -> RelationCounts:
    """The counts of a scene; `stands_for` gives the true object of each found object that has one."""
    sure = {
        _key(label.relation, label.a, label.b)
        for label in truth
        if label.confidence >= LEAST_CONFIDENCE and label.relation != NONE and TABLE not in (label.a, label.b)
    }
    doubtful = {frozenset((label.a, label.b)) for label in truth if label.confidence < LEAST_CONFIDENCE}
    right = n = 0
    for relation in perceived:
        if relation.relation == NONE or TABLE in (relation.a, relation.b):
            continue
        # A negative number is no object's.
        a, b = stands_for.get(relation.a, -relation.a), stands_for.get(relation.b, -relation.b)
        if frozenset((a, b)) not in doubtful:
            n += 1
            right += _key(relation.relation, a, b) in sure
    return RelationCounts(right, n, len(sure))


def _key(relation: str, a: int, b: int) -> tuple[str, int, int]:
    return (relation, min(a, b), max(a, b)) if relation in SYMMETRIC else (relation, a, b)
