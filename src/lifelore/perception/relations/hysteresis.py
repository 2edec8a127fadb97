"""`RelationFilter`: removes flicker from the relations of a stream of clouds.

A label of a pair is accepted after `hold` frames in a row with a confidence of at least `enter`. It is dropped
when another label is accepted, or after `hold` frames in a row without a confidence of at least `leave`. So a pair
changes at most once in `hold` frames, a label that alternates with others from frame to frame is never accepted
for ``hold ≥ 2``, and a pair never has two labels: ``on(a, b)`` and ``on(b, a)`` exclude each other. Loops over
three and more objects can arise while pairs change at different frames; `scene_logic.most_likely_scene` after the
filter removes them.

The thesis uses single clouds; a robot sees a stream (§2.4.3 proposes to observe what moves together).
"""

from collections.abc import Iterable
from dataclasses import dataclass

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import NONE, SYMMETRIC
from lifelore.perception.relations.relation import Relation


@dataclass
class _Pair:
    """State of a pair."""

    accepted: Relation | None = None
    doubted: int = 0
    challenger: tuple[str, int, int] | None = None
    seen: int = 0


class RelationFilter:
    """Filters the relations of successive frames.

    Parameters
    ----------
    enter : float
        Least confidence that supports a new label, in [0, 1].
    leave : float
        Confidence below which a frame counts against an accepted label, in [0, `enter`].
    hold : int
        Frames in a row, ≥ 1.

    Raises
    ------
    InputError
        A setting is outside its range.

    Examples
    --------
    >>> stream = RelationFilter(hold=2)
    >>> [len(stream.update([Relation(2, 1, "on", 0.9, 0.0)])) for _ in range(3)]
    [0, 1, 1]
    """

    def __init__(self, enter: float = 0.6, leave: float = 0.4, hold: int = 3) -> None:
        if not 0 <= leave <= enter <= 1 or hold < 1:
            raise InputError(f"0 ≤ leave ≤ enter ≤ 1 and hold ≥ 1 are needed, got {leave}, {enter} and {hold}")
        self.enter, self.leave, self.hold = enter, leave, hold
        self._pairs: dict[tuple[int, int], _Pair] = {}

    def update(self, relations: Iterable[Relation]) -> tuple[Relation, ...]:
        """Process one frame; returns the accepted relations, pairs ascending, without *none*.

        Of several relations of one pair the most confident counts; pairs without a relation in the frame are
        unseen. An accepted relation carries the confidence and gap with which it was last seen.
        """
        frame: dict[tuple[int, int], Relation] = {}
        for relation in sorted(relations, key=lambda r: (-r.confidence, _key(r))):
            frame.setdefault((min(relation.a, relation.b), max(relation.a, relation.b)), relation)
        for pair in sorted({*frame, *self._pairs}):
            self._step(self._pairs.setdefault(pair, _Pair()), frame.get(pair))
        self._pairs = {pair: m for pair, m in self._pairs.items() if m.accepted or m.challenger}
        return self.accepted

    @property
    def accepted(self) -> tuple[Relation, ...]:
        """The accepted relations, without a new frame."""
        all_accepted = (self._pairs[pair].accepted for pair in sorted(self._pairs))
        return tuple(relation for relation in all_accepted if relation and relation.relation != NONE)

    def _step(self, memory: _Pair, seen: Relation | None) -> None:
        if seen is not None and seen.confidence >= self.enter and not _same(memory.accepted, seen):
            memory.seen = memory.seen + 1 if memory.challenger == _key(seen) else 1
            memory.challenger = _key(seen)
        else:
            memory.challenger, memory.seen = None, 0
        if seen is not None and memory.seen >= self.hold:
            memory.accepted, memory.doubted, memory.challenger, memory.seen = seen, 0, None, 0
        elif memory.accepted is not None:
            self._doubt(memory, seen)

    def _doubt(self, memory: _Pair, seen: Relation | None) -> None:
        """Update the accepted relation, or count against it."""
        if seen is not None and _same(memory.accepted, seen) and seen.confidence >= self.leave:
            memory.accepted, memory.doubted = seen, 0
            return
        memory.doubted += 1
        if memory.doubted >= self.hold:
            # The challenger restarts, or the pair would change again within `hold` frames.
            memory.accepted, memory.doubted, memory.challenger, memory.seen = None, 0, None, 0


def _key(relation: Relation) -> tuple[str, int, int]:
    a, b = relation.a, relation.b
    if relation.relation in SYMMETRIC and TABLE not in (a, b):
        a, b = min(a, b), max(a, b)
    return relation.relation, a, b


def _same(accepted: Relation | None, seen: Relation) -> bool:
    return accepted is not None and _key(accepted) == _key(seen)
