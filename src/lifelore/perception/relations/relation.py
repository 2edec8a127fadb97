"""A predicate of a scene: ``relation(a, b)``, how sure, and how far apart the two look."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Relation:
    """One perceived relation.

    Parameters
    ----------
    a, b : int
        Objects of the scene (2 and above) or the table (1); symmetric relations stand once, with a < b.
    relation : str
        A name of the model's vocabulary.
    confidence : float
        In [0, 1].
    gap : float
        How near the visible points of the two come, metres (`near_pairs.visible_gap`: the mean of the up to five
        smallest distances from points of the lower-numbered object, or of what is not the table, to the other);
        infinity for a far pair.
    """

    a: int
    b: int
    relation: str
    confidence: float
    gap: float
