"""`PairBelief`: how likely each relation is for one pair, before anybody decides."""

from collections.abc import Mapping
from dataclasses import dataclass

from lifelore.perception.pairs.directed_label import REVERSED
from lifelore.perception.relations.relation import Relation


@dataclass(frozen=True)
class PairBelief:
    """What a model thinks of a pair.

    Parameters
    ----------
    a, b : int
        a < b, or an object and the table.
    gap : float
        Visible gap, metres.
    shares : mapping of str to float
        Probability of each relation of (a, b); a name that starts with ``~`` is of (b, a). They sum to 1, but for
        a model of several labels, where each is a probability by itself.
    """

    a: int
    b: int
    gap: float
    shares: Mapping[str, float]

    def best(self) -> Relation:
        """The likeliest relation; of equal ones the first by name."""
        name = max(sorted(self.shares), key=self.shares.__getitem__)
        return self.relation(name)

    def relation(self, name: str) -> Relation:
        """One of the names as a relation, with its probability."""
        a, b = (self.b, self.a) if name.startswith(REVERSED) else (self.a, self.b)
        return Relation(a, b, name.removeprefix(REVERSED), self.shares[name], self.gap)
