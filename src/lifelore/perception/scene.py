"""`Scene`: all layers of a scene, from the points to contact point networks and relations.

The layers of thesis Fig. 2.8: the cloud; the contact point networks, one an object, merged over all the pairs it
takes part in (§2.3.6), with the contact edges between them; the relations. Holes, facts, planning problems and
other results are computed from a `Scene` in their own modules.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import NONE
from lifelore.perception.contacts.contact_network import ContactPointNetwork
from lifelore.perception.contacts.contact_points import ContactPoint
from lifelore.perception.contacts.interface import Interface
from lifelore.perception.relations.relation import PairBelief, Relation
from lifelore.perception.relations.words import NO_WORDS, Words

TABLE_NAME = "table"


@dataclass(frozen=True)
class ContactEdge:
    """Node `node_a` of object `a`'s network faces node `node_b` of `b`'s, `length` metres away.

    The dashed lines of thesis Fig. 2.2. Node numbers are those of the merged networks.
    """

    a: int
    node_a: int
    b: int
    node_b: int
    length: float


@dataclass(frozen=True, eq=False)
class Scene:
    """A scene in layers (thesis §2.5, Fig. 2.8).

    Parameters
    ----------
    cloud : LabelledCloud
        The lowest layer; its objects are the scene's objects.
    interfaces : tuple of Interface
        One for each near pair of objects, or of an object and the table.
    relations : tuple of Relation
        The predicates; see `scene_logic.most_likely_scene` for making them consistent.
    optimal : bool
        False where the solver could not prove that no consistent scene is likelier.
    beliefs : tuple of PairBelief
        Probabilities of all relations of each near pair, where a model gave them.
    words : Words
        Relations outside the core vocabulary that were looked for, whether or not a pair has them.

    Raises
    ------
    InputError
        An interface or a relation names an object that has no points, or a pair has two interfaces.

    Examples
    --------
    >>> from lifelore import perceived_scene
    >>> plane = np.stack(np.meshgrid(np.linspace(0, 1, 30), np.linspace(0, 1, 30)), -1).reshape(-1, 2)
    >>> sizes = ((1, 0), (0.1, 0.05), (0.1, 0.06))  # the table, and two plates above each other
    >>> points = [np.column_stack([side * plane, np.full(900, height)]) for side, height in sizes]
    >>> scene = perceived_scene(LabelledCloud(np.concatenate(points), np.repeat([1, 2, 3], 900)))
    >>> scene.objects, len(scene.networks[2].nodes) > 0
    ((2, 3), True)
    """

    cloud: LabelledCloud
    interfaces: tuple[Interface, ...] = ()
    relations: tuple[Relation, ...] = ()
    optimal: bool = True
    beliefs: tuple[PairBelief, ...] = ()
    words: Words = NO_WORDS

    def __post_init__(self) -> None:
        known = {*self.objects, TABLE}
        for kind, parts in (("interface", self.interfaces), ("relation", self.relations)):
            for part in parts:
                if not {part.a, part.b} <= known:
                    raise InputError(
                        f"{kind} ({part.a}, {part.b}) must join objects that have points: {sorted(known)}"
                    )
        pairs = [frozenset((part.a, part.b)) for part in self.interfaces]
        if len(set(pairs)) < len(pairs):
            raise InputError("interfaces must name each pair once; merge the contacts of a pair before")

    @cached_property
    def objects(self) -> tuple[int, ...]:
        """Numbers of the objects, ascending; the table is not among them."""
        return self.cloud.objects

    @cached_property
    def _sides(self) -> tuple[tuple[int, tuple[ContactPoint, ...], int], ...]:
        """For each interface its two sides in turn: (object, contacts, number of its first node)."""
        filled: dict[int, int] = {}
        sides = []
        for interface in self.interfaces:
            for label, contacts in ((interface.a, interface.contacts_a), (interface.b, interface.contacts_b)):
                sides.append((label, tuple(contacts), filled.get(label, 0)))
                filled[label] = filled.get(label, 0) + len(contacts)
        return tuple(sides)

    @cached_property
    def networks(self) -> dict[int, ContactPointNetwork]:
        """The merged network of every object (thesis §2.3.6), of the table too where it has contacts.

        Nodes stand in the order of the interfaces; an object that touches nothing has an empty network.
        """
        nodes: dict[int, list[ContactPoint]] = {label: [] for label in self.objects}
        for label, contacts, _ in self._sides:
            nodes.setdefault(label, []).extend(contacts)
        return {label: ContactPointNetwork.from_contacts(label, nodes[label]) for label in sorted(nodes)}

    @cached_property
    def contact_edges(self) -> tuple[ContactEdge, ...]:
        """Which node faces which, over all pairs, in the order of the interfaces."""
        edges = []
        for number, interface in enumerate(self.interfaces):
            (a, contacts_a, first_a), (b, contacts_b, first_b) = self._sides[2 * number : 2 * number + 2]
            for i, j in np.asarray(interface.contact_edges, np.int64).reshape(-1, 2).tolist():
                apart = float(np.linalg.norm(contacts_a[i].position - contacts_b[j].position))
                edges.append(ContactEdge(a, first_a + i, b, first_b + j, apart))
        return tuple(edges)

    @cached_property
    def without_unrelated_contacts(self) -> "Scene":
        """The same scene without the interfaces of near pairs whose relation is *none*.

        Separators find facing points between unrelated objects too, up to `ContactSettings.near` apart; these
        points are left out of the networks. Pairs without any relation stay.
        """
        unrelated = {frozenset((r.a, r.b)) for r in self.relations if r.relation == NONE}
        near = tuple(part for part in self.interfaces if frozenset((part.a, part.b)) not in unrelated)
        return replace(self, interfaces=near)

    def with_words(self, relations: Iterable[Relation], words: Words) -> "Scene":
        """The same scene with relations of a user's own words added."""
        return replace(self, relations=(*self.relations, *relations), words=words)

    def position(self, label: int, node: int) -> NDArray[np.float64]:
        """Where a node of an object's network is, shape ``(3,)``, metres."""
        return self.networks[label].nodes[node].position

    def relation_of(self, a: int, b: int) -> Relation | None:
        """The first relation between the two, in either direction; None where none is known."""
        return next((r for r in self.relations if {r.a, r.b} == {a, b}), None)


def object_name(label: int) -> str:
    """Name of an object: ``table``, or its number."""
    return TABLE_NAME if label == TABLE else str(label)
