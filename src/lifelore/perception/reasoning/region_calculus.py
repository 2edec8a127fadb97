"""Scenes in the region connection calculus: which bodies touch (EC) and which do not (DC).

Solid bodies share no volume, so of RCC-8's eight base relations only two can hold between two objects: *externally
connected* and *disconnected*. What rests on something touches it, however wide the gap *looks*: the faces in
contact are hidden from the camera. Neighbours touch when they look as near as points of touching bodies do.

Thesis: §2.2 and §2.5 (Randell et al. 1992): perception grounds the calculus.
"""

from collections.abc import Iterable
from itertools import combinations

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, BOTH, ON
from lifelore.perception.reasoning.fact import Fact, objects_without_support, words_outside_core
from lifelore.perception.relations.relation import Relation

DISCONNECTED, EXTERNALLY_CONNECTED = "dc", "ec"

TOUCHING = 0.004
"""Metres. Visible gap up to which neighbours are said to touch: two pixels of a Kinect on a table."""


def region_relations(
    relations: Iterable[Relation], objects: Iterable[int] = (), *, touching: float = TOUCHING
) -> tuple[Fact, ...]:
    """``ec`` or ``dc`` for every pair of objects, and of each object and the table; both are symmetric, a < b.

    Parameters
    ----------
    relations : iterable of Relation
        With a word outside the core vocabulary, which may mean touching, and an object that no *on* or *both*
        supports, no DC is stated.
    objects : iterable of int
        Objects beside those the relations name. Pairs without a relation are far apart: DC.
    touching : float
        Metres, ≥ 0.
    """
    relations = tuple(relations)
    everything = sorted({TABLE, *objects, *(label for r in relations for label in (r.a, r.b))})
    touch = {
        (min(r.a, r.b), max(r.a, r.b))
        for r in relations
        if r.relation in (ON, BOTH) or (r.relation == ADJACENT and r.gap <= touching)
    }
    apart_too = not (words_outside_core(relations) and objects_without_support(relations, objects))
    return tuple(
        Fact(EXTERNALLY_CONNECTED if pair in touch else DISCONNECTED, pair)
        for pair in combinations(everything, 2)
        if apart_too or pair in touch
    )
