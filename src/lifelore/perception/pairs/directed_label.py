"""A relation of an ordered pair as one class: its name and which of the two comes first.

The thesis's pairs had a fixed order; here the direction is inferred, so ``on(a, b)`` and ``on(b, a)`` are two
classes of the row (a, b), and a symmetric relation is one.
"""

from collections.abc import Collection, Iterable, Sequence

from lifelore.core.relations import PairLabel

REVERSED = "~"
"""Before a name: it holds of the pair in the other order."""


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
    """The class of what `label` says, for the pair in the order that starts with `a`."""
    return label.relation if label.a == a else mirrored(label.relation, symmetric)


def mirror_order(classes: Sequence[str], symmetric: Collection[str]) -> list[int]:
    """Where each class finds its mirror image: ``shares[:, order]`` are the shares of the turned pair."""
    return [list(classes).index(mirrored(name, symmetric)) for name in classes]
