"""What the types of a life have shown of moves: causes and outcomes by their codes."""

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.any_tasks.moves import Counts
from lifelore.agent.types.type_counts import TypeCounts

Array = NDArray[np.float64]

MOST_EFFECTS = 12
"""Most outcomes of a cause that are told apart; the rest counts as never shown."""


class KnownMoves(TypeCounts):
    """Counts of outcomes by cause, of several types.

    Causes and outcomes are numbered when they are read, so that memories of several robots merge in any order. The
    last effect of each cause stands for all outcomes that no type has shown: a cause of which nothing is known but
    its outcomes has each with the same probability, and one more. The kind of a cause is 0 where it is that of the
    next state, 1 where it is that of a reward.

    Parameters
    ----------
    types : sequence of Counts
        Of causes and outcomes, by type.
    """

    def __init__(self, types: Sequence[Counts]) -> None:
        self.codes = sorted({cause for one in types for cause, _ in one})
        self._places = {code: place for place, code in enumerate(self.codes)}
        rows: list[Counter[int]] = [Counter() for _ in self.codes]
        for one in types:
            for (cause, outcome), count in one.items():
                rows[self._places[cause]][outcome] += count
        self._effects = [_most(row) for row in rows]
        shown = np.array([len(row) for row in self._effects], np.int64)[:, None]
        effects = np.arange(1 + max(shown.max(initial=0), 0))
        known = (effects < shown) | (effects == effects[-1])
        broad: Array = known / (shown + 1)
        counts = np.array([self._counted(one, broad.shape) for one in types]).reshape(len(types), *broad.shape)
        super().__init__(counts, broad, np.array(self.codes, np.int64) & 1)

    def place(self, cause: int, outcome: int) -> tuple[int, int] | None:
        """Numbers of a cause and its effect, by their codes; None for a cause that no type has shown."""
        place = self._places.get(cause)
        return None if place is None else (place, self._effects[place].get(outcome, -1))

    def own(self, moves: Counts) -> Array:
        """The counts of moves, (n_causes, n_effects); those of unknown causes are left out."""
        return self._counted(moves, self.broad.shape)

    def _counted(self, moves: Counts, shape: tuple[int, ...]) -> Array:
        counts = np.zeros(shape)
        for (cause, outcome), count in moves.items():
            found = self.place(cause, outcome)
            if found is not None:
                counts[found] += count
        return counts


def _most(row: Mapping[int, float]) -> dict[int, int]:
    """Numbers of the most counted outcomes, in the order of their codes."""
    kept = sorted(row, key=lambda outcome: (-row[outcome], outcome))[:MOST_EFFECTS]
    return {outcome: number for number, outcome in enumerate(sorted(kept))}
