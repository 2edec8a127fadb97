"""Relations of a scene: ``relation(a, b)`` with confidence and gap, and the probabilities of all relations of a
pair."""

from collections.abc import Mapping
from dataclasses import dataclass

from lifelore.perception.pairs.directed_label import REVERSED


@dataclass(frozen=True)
class Relation:
    """A predicted relation.

    Parameters
    ----------
    a, b : int
        Objects of the scene (2 and above) or the table (1); symmetric relations stand once, with a < b.
    relation : str
        A name of the model's vocabulary.
    confidence : float
        In [0, 1].
    gap : float
        Visible gap of the two, metres (`near_pairs.visible_gap`: the mean of the up to five smallest distances
        from points of the lower-numbered object, or of the object beside the table, to the other); infinity for a
        far pair.
    """

    a: int
    b: int
    relation: str
    confidence: float
    gap: float


@dataclass(frozen=True)
class PairBelief:
    """Probabilities of the relations of a pair.

    Parameters
    ----------
    a, b : int
        a < b, or an object and the table.
    gap : float
        Visible gap, metres.
    shares : mapping of str to float
        Probability of each relation of (a, b); a name that starts with ``~`` is of (b, a). They sum to 1, except
        in a multi-label model, where each is a separate probability.
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
        """A relation by its name, with its probability as confidence."""
        a, b = (self.b, self.a) if name.startswith(REVERSED) else (self.a, self.b)
        return Relation(a, b, name.removeprefix(REVERSED), self.shares[name], self.gap)
