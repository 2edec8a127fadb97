"""The known types of a life as recognition reads them: alike ones joined, with what they have shown and where."""

from collections import Counter
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.any_tasks.experience import Experience
from lifelore.agent.any_tasks.known_moves import KnownMoves
from lifelore.agent.any_tasks.moves import Counts
from lifelore.agent.types.same_type import JoinedType
from lifelore.agent.types.type_prior import Sightings

Array = NDArray[np.float64]


class KnownTypes:
    """The known types.

    Parameters
    ----------
    experience : Experience
        Read once.

    Attributes
    ----------
    types : list of JoinedType
    moves : KnownMoves
        Of these types, in their order.
    frequency : (n_causes,) float64
        Number of tasks that have shown each cause.
    """

    def __init__(self, experience: Experience) -> None:
        self.experience = experience
        names = sorted(experience.types)
        apart = KnownMoves([experience.types[name].moves for name in names])
        self.types = [JoinedType(tuple(names[number] for number in group)) for group in apart.joined()]
        some_joined = len(self.types) < len(names)
        self.moves = KnownMoves([self._moves(one.members) for one in self.types]) if some_joined else apart
        self.frequency = np.array([experience.causes[code, 0] for code in self.moves.codes])

    def __len__(self) -> int:
        return len(self.types)

    def _moves(self, members: Sequence[str]) -> Counts:
        return sum((self.experience.types[name].moves for name in members), Counter())

    def sightings(self) -> Sightings:
        """Where these types were seen."""
        types = self.experience.types
        return Sightings.of([[types[name].sightings for name in one.members] for one in self.types])
