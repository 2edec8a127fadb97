"""`Fact`: a statement about a scene's objects, such as ``between(3, 2, 4)``, and conditions for deriving facts.

That no object rests on another, or that two objects do not touch, follows from relations that are absent. So it
follows only where every object has an *on* or *both* that supports it. Nothing is derived from a user's own names:
*rests upon* may mean *on*, or not.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import BOTH, CORE_RELATIONS, ON
from lifelore.perception.relations.relation import Relation
from lifelore.perception.scene import object_name


@dataclass(frozen=True, order=True)
class Fact:
    """A name and the objects it is said of, in the order the name's definition gives them.

    Examples
    --------
    >>> str(Fact("on", (3, 1)))
    'on(3, table)'
    """

    name: str
    arguments: tuple[int, ...]

    def __str__(self) -> str:
        return f"{self.name}({', '.join(map(object_name, self.arguments))})"


def words_outside_core(relations: Iterable[Relation]) -> tuple[str, ...]:
    """The words outside the core vocabulary, sorted."""
    return tuple(sorted({r.relation for r in relations} - set(CORE_RELATIONS)))


def objects_without_support(relations: Iterable[Relation], objects: Iterable[int] = ()) -> tuple[int, ...]:
    """The objects, `objects` and those the relations name, of which nothing says what they rest on; ascending."""
    relations = tuple(relations)
    carried = {r.a for r in relations if r.relation in (ON, BOTH)}
    return tuple(sorted({*objects, *(label for r in relations for label in (r.a, r.b))} - carried - {TABLE}))
