"""Classes of an ordered pair: the name of a relation and its direction; the class that a pair's labels teach.

The thesis's pairs had a fixed order; here the direction is inferred, so ``on(a, b)`` and ``on(b, a)`` are two
classes of the row (a, b), and a symmetric relation is one.
"""

from collections.abc import Collection, Iterable, Sequence

from lifelore.core.errors import InputError
from lifelore.core.relations import PairLabel

LEAST_CONFIDENCE = 2
"""Least confidence of a label in training; labels below it are doubtful."""
REVERSED = "~"
"""Prefix of a name that holds for the pair in the other order."""


def directed_classes(vocabulary: Iterable[str], symmetric: Collection[str]) -> tuple[str, ...]:
    """All classes of an ordered pair, sorted."""
    names = set(vocabulary)
    return tuple(sorted(names | {REVERSED + name for name in names - set(symmetric)}))


def mirrored(name: str, symmetric: Collection[str]) -> str:
    """The class of the same pair in the other order."""
    if name in symmetric:
        return name
    return name.removeprefix(REVERSED) if name.startswith(REVERSED) else REVERSED + name


def as_directed(label: PairLabel, a: int, symmetric: Collection[str]) -> str:
    """The class of `label` for the pair in the order that starts with `a`."""
    return label.relation if label.a == a else mirrored(label.relation, symmetric)


def mirror_order(classes: Sequence[str], symmetric: Collection[str]) -> list[int]:
    """Index of each class's mirror image: ``shares[:, order]`` are the shares of the pair in the other order."""
    return [list(classes).index(mirrored(name, symmetric)) for name in classes]


def pair_class(labels: Sequence[PairLabel], first: int, symmetric: Collection[str]) -> str:
    """The directed class, in the order that starts with `first`, of all labels of a pair; at least one.

    A repeated label, or a symmetric one in both orders, is one class.

    Raises
    ------
    InputError
        The labels are of more than one class.
    """
    classes = [as_directed(label, first, symmetric) for label in labels]
    for label, other in zip(labels, classes, strict=True):
        if other != classes[0]:
            known = labels[0]
            raise InputError(
                f"truths must give a pair one relation, got {known.relation}({known.a}, {known.b}) and"
                f" {label.relation}({label.a}, {label.b}); several may hold with multi_label=True"
            )
    return classes[0]
