"""Vocabulary of relations between two objects: *on*, *adjacent*, *both*, *none*, and labels of pairs.

For an ordered pair (a, b): *on*: a rests on b. *adjacent*: side by side, the visible gap at most `ADJACENT_GAP`,
neither carries the other (symmetric). *both*: b carries a in part, and a stands beside b or leans on it.
*none*: near, but none of these. Thesis: §2.4.1, where the label is a vector r in {0, 1}² of (on, adjacent).
"""

from dataclasses import dataclass

ON, ADJACENT, BOTH, NONE = "on", "adjacent", "both", "none"
CORE_RELATIONS = (ON, ADJACENT, BOTH, NONE)
SYMMETRIC = frozenset({ADJACENT, NONE})
"""Relations that hold of (b, a) when they hold of (a, b)."""

ADJACENT_GAP = 0.0225
"""Metres. Visible gaps of hand-labelled neighbours overlap with those of strangers from 20 to 30 mm, so the limit
is a stated parameter in the middle of 20–25 mm, not learned from a handful of examples."""


@dataclass(frozen=True)
class PairLabel:
    """A label of a pair: ``relation(a, b)`` with confidence 3 (certain), 2 (probable) or 1 (doubtful).

    Examples
    --------
    >>> PairLabel(3, 4, "on")
    PairLabel(a=3, b=4, relation='on', confidence=3)
    """

    a: int
    b: int
    relation: str
    confidence: int = 3
