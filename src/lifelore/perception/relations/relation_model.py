"""`RelationModel`: all that a fitted relation classifier consists of, as plain data that a file can hold."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lifelore.core.errors import InputError
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.pairs import gap_rule
from lifelore.perception.relations.displacement_relations import DisplacementRelations, NeighbourSettings
from lifelore.perception.trees.tree_relations import TreeRelations, Vocabulary

METHODS = ("trees", "displacement")
OBJECTS, WITH_TABLE = "objects", "table"
"""Names of the two parts of a model with one class a pair: pairs of objects, and pairs with the table."""


@dataclass(frozen=True, eq=False)
class RelationModel:
    """Options, names and learned parts of a `RelationClassifier`.

    Parameters
    ----------
    method, adjacent_gap, multi_label
        As in `RelationClassifier`.
    settings : ContactSettings
        How contacts are found, the same in training and in use.
    neighbours : NeighbourSettings
        Of the method ``"displacement"``.
    names : tuple of str
        The learned relations, sorted.
    symmetric : frozenset of str
    models : dict of str to TreeRelations or DisplacementRelations
        By `OBJECTS` and `WITH_TABLE`; with `multi_label` by relation.

    Raises
    ------
    InputError
        An option breaks its rule.
    """

    method: str
    adjacent_gap: float | None
    multi_label: bool
    settings: ContactSettings
    neighbours: NeighbourSettings
    names: tuple[str, ...]
    symmetric: frozenset[str]
    models: Mapping[str, TreeRelations | DisplacementRelations] = field(repr=False)

    def __post_init__(self) -> None:
        check_options(self.method, self.adjacent_gap, self.multi_label)

    @property
    def vocabulary(self) -> Vocabulary:
        """The learned names, see `learned_vocabulary`."""
        return learned_vocabulary(self.method, self.adjacent_gap, self.multi_label, self.names, self.symmetric)


def check_options(method: str, adjacent_gap: float | None, multi_label: bool) -> None:
    """Raise InputError for options of a `RelationClassifier` that break a rule."""
    if method not in METHODS:
        raise InputError(f"method must be one of {', '.join(METHODS)}, got {method!r}")
    if multi_label and method != "trees":
        raise InputError("multi_label needs method 'trees', got 'displacement'; drop one of the two")
    if adjacent_gap is not None and not 0 < adjacent_gap < 1:
        raise InputError(f"adjacent_gap must be metres in (0, 1), got {adjacent_gap!r}; 0.0225 is 22.5 mm")


def learned_vocabulary(
    method: str, adjacent_gap: float | None, multi_label: bool, names: tuple[str, ...], symmetric: frozenset[str]
) -> Vocabulary:
    """The names, which of them are symmetric, and the limit of *adjacent* where the gap rule applies."""
    applies = gap_rule.applies(names, adjacent_gap) and method == "trees" and not multi_label
    return Vocabulary(names, symmetric, adjacent_gap if applies else None)
