"""Whether relations say, in the core words, all that other facts are derived from.

That nothing rests on a thing, or that two things do not touch, follows from what is *not* said; so it follows only
where *on*, *adjacent*, *both* and *none* are the words, and say of every object what carries it. Of a user's own
words nothing is known: *rests upon* may mean what *on* means, or not.
"""

from collections.abc import Iterable

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import BOTH, CORE_RELATIONS, ON
from lifelore.perception.relations.relation import Relation


def other_words(relations: Iterable[Relation]) -> tuple[str, ...]:
    """The words outside the core vocabulary, sorted."""
    return tuple(sorted({r.relation for r in relations} - set(CORE_RELATIONS)))


def without_carrier(relations: Iterable[Relation], objects: Iterable[int] = ()) -> tuple[int, ...]:
    """The objects, `objects` and those the relations name, of which nothing says what they rest on; ascending."""
    relations = tuple(relations)
    carried = {r.a for r in relations if r.relation in (ON, BOTH)}
    return tuple(sorted({*objects, *(label for r in relations for label in (r.a, r.b))} - carried - {TABLE}))
