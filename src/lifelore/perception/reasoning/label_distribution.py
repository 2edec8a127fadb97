"""`LabelDistribution`: how likely each label of the core vocabulary is for a pair, ready to be reasoned with."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, BOTH, CORE_RELATIONS, NONE, ON, SYMMETRIC
from lifelore.perception.relations.relation import Relation

FLOOR = 1e-6
"""Least probability of a label: a classifier's 0 means "never seen", and a rule may still force the label."""

Label = tuple[str, int, int]
"""A relation with its direction, (relation, a, b); symmetric relations with a < b."""


@dataclass(frozen=True)
class LabelDistribution:
    """A distribution over the labels of two objects, or of an object and the table.

    Parameters
    ----------
    labels : tuple of Label
        All that can be said of the pair, from the least claim to the boldest.
    probabilities : tuple of float
        One a label, at least `FLOOR`; they sum to 1 but for the floor.
    gap : float
        Visible gap, metres; infinity where unknown.
    """

    labels: tuple[Label, ...]
    probabilities: tuple[float, ...]
    gap: float

    @classmethod
    def from_candidates(cls, candidates: Iterable[Relation]) -> "LabelDistribution":
        """From relations over one pair that are alternatives, their confidences being probabilities.

        What the confidences leave of 1 is shared alike by the labels not named (nothing is known that prefers one
        of them); confidences that sum to more than 1 are divided by their sum. A label named twice counts once,
        with the higher confidence.
        """
        candidates = tuple(candidates)
        labels = pair_labels(candidates[0].a, candidates[0].b)
        named: dict[Label, float] = {}
        for relation in candidates:
            label = relation_label(relation)
            if label in labels:
                named[label] = max(named.get(label, 0.0), relation.confidence)
        total = sum(named.values())
        rest = max(1 - total, 0.0) / max(len(labels) - len(named), 1)
        shares = (named.get(label, rest) / (max(total, 1.0) if label in named else 1.0) for label in labels)
        return cls(labels, tuple(max(share, FLOOR) for share in shares), min(r.gap for r in candidates))

    @property
    def pair(self) -> tuple[int, int]:
        """The two, lower first; the table comes second."""
        return self.labels[0][1:]

    @property
    def likeliest(self) -> int:
        """Number of the most probable label; of equals, the one that claims least."""
        return max(range(len(self.labels)), key=lambda k: (self.probabilities[k], -k))

    def cost(self, number: int) -> float:
        """``-ln p`` of a label, nats."""
        return -math.log(self.probabilities[number])

    def carried(self, thing: int) -> float:
        """Probability that this object of the pair rests on the other, in [0, 1]."""
        steps = ((carries(label), p) for label, p in zip(self.labels, self.probabilities, strict=True))
        return min(sum(p for step, p in steps if step is not None and step[0] == thing), 1.0)

    @property
    def beside(self) -> float:
        """Probability that the two stand side by side, whether or not one carries the other, in [0, 1]."""
        pairs = zip(self.labels, self.probabilities, strict=True)
        return min(sum(p for label, p in pairs if label[0] in (ADJACENT, BOTH)), 1.0)

    def relation(self, number: int) -> Relation:
        """A label of the pair as a `Relation`, its probability the confidence."""
        name, a, b = self.labels[number]
        return Relation(a, b, name, min(self.probabilities[number], 1.0), self.gap)


def pair_labels(a: int, b: int) -> tuple[Label, ...]:
    """All that the core vocabulary can say of a pair, least claim first; nothing carries the table."""
    if TABLE in (a, b):
        thing = max(a, b)
        return tuple((name, thing, TABLE) for name in (NONE, ADJACENT, ON, BOTH))
    a, b = min(a, b), max(a, b)
    return ((NONE, a, b), (ADJACENT, a, b), (ON, a, b), (ON, b, a), (BOTH, a, b), (BOTH, b, a))


def relation_label(relation: Relation) -> Label:
    """The label a relation states, in the form `pair_labels` gives: symmetric ones ordered, the table last."""
    a, b = relation.a, relation.b
    if relation.relation in SYMMETRIC:
        a, b = (max(a, b), TABLE) if TABLE in (a, b) else (min(a, b), max(a, b))
    return relation.relation, a, b


def carries(label: Label) -> tuple[int, int] | None:
    """(what rests, what it rests on), or None where neither carries the other."""
    return label[1:] if label[0] in (ON, BOTH) else None


def label_distributions(candidates: Iterable[Relation]) -> tuple[LabelDistribution, ...]:
    """What `candidates` of the core vocabulary amount to, pairs ascending, those with the table last.

    Raises
    ------
    InputError
        A confidence is outside [0, 1], or a relation joins an object to itself.
    """
    by_pair: dict[tuple[bool, int, int], list[Relation]] = {}
    for relation in candidates:
        a, b = sorted((relation.a, relation.b))
        if a == b or not 0 <= relation.confidence <= 1:
            raise InputError(f"a relation must join two objects with a confidence in [0, 1], got {relation}")
        if relation.relation in CORE_RELATIONS:
            by_pair.setdefault((a == TABLE, a, b), []).append(relation)
    return tuple(LabelDistribution.from_candidates(by_pair[pair]) for pair in sorted(by_pair))
