"""What a pick shows of relations: what falls when an object is lifted lay on it, and what stays did not.

What happened is evidence, and perception's belief in each relation r of a near pair is its prior:

    P(r | happened) ∝ P(happened | whether the lifted object carries the other under r) P(r)

The likeliest relation becomes a label of the pair, as sure as it is now. So a life labels its own scenes, and
corrects perception where that was wrong.
"""

from collections.abc import Container
from dataclasses import dataclass

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import BOTH, ON, PairLabel
from lifelore.perception.pairs.directed_label import REVERSED
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.relations.relation import PairBelief

LIVED = "lived"
"""Name of the relation models that learn from these scenes."""
FALLS = {True: 0.7, False: 0.02}
"""P(an object falls | whether the lifted object carries it), as the forces on 132 trays for development had it: 10
of 13 pairs and 5 of 346. What lies on a lifted object may also ride along, or fall too little."""
CERTAIN, PROBABLE = 0.95, 0.8
"""Least probabilities of labels with confidence 3 and 2; others are doubtful, and nothing learns from them."""


@dataclass(frozen=True, eq=False)
class TrayPairs:
    """The near pairs of a tray as perceived.

    Parameters
    ----------
    pairs : ScenePairs
    beliefs : tuple of PairBelief
    label : dict of int to int
        The label in the cloud of each object that has just one.
    """

    pairs: ScenePairs
    beliefs: tuple[PairBelief, ...]
    label: dict[int, int]

    def shown_by(self, lifted: int, fallen: Container[int], knocked: Container[int]) -> list[PairLabel]:
        """Labels of the near pairs of a lifted object. A pair with a knocked object gets none."""
        number = {label: k for k, label in self.label.items()}
        found = []
        for belief in self.beliefs:
            first, second = number.get(belief.a), number.get(belief.b)
            if belief.b == TABLE or lifted not in (first, second):
                continue
            other_first = second == lifted
            other = first if other_first else second
            if other is not None and other not in knocked:
                found.append(_label(belief, "" if other_first else REVERSED, other in fallen))
        return found


def _label(belief: PairBelief, order: str, fell: bool) -> PairLabel:
    """The likeliest relation of a pair; names after `order` are of the other object on the lifted one."""
    carried = {order + ON, order + BOTH}
    weights = {
        name: share * (FALLS[name in carried] if fell else 1 - FALLS[name in carried])
        for name, share in belief.shares.items()
    }
    best = max(sorted(weights), key=weights.__getitem__)
    sure = weights[best] / max(sum(weights.values()), 1e-300)
    relation = belief.relation(best)
    return PairLabel(relation.a, relation.b, relation.relation, 1 + (sure >= PROBABLE) + (sure >= CERTAIN))
