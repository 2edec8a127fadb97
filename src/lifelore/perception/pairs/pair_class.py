"""What truths say of a pair as the one class that it teaches; labels that contradict each other are refused."""

from collections.abc import Collection, Sequence

from lifelore.core.errors import InputError
from lifelore.core.relations import PairLabel
from lifelore.perception.pairs.directed_label import as_directed

LEAST_CONFIDENCE = 2
"""Labels below it are not learnt from: their own author doubts them."""


def pair_class(said: Sequence[PairLabel], first: int, symmetric: Collection[str]) -> str:
    """The directed class, in the order that starts with `first`, of all labels of a pair; at least one.

    A relation said twice, or a symmetric one said in both orders, is one class.

    Raises
    ------
    InputError
        The labels are of more than one class.
    """
    classes = [as_directed(label, first, symmetric) for label in said]
    for label, other in zip(said, classes, strict=True):
        if other != classes[0]:
            one = said[0]
            raise InputError(
                f"truths must give a pair one relation, got {one.relation}({one.a}, {one.b}) and"
                f" {label.relation}({label.a}, {label.b}); several may hold with multi_label=True"
            )
    return classes[0]
