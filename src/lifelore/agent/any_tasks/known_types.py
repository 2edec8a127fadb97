"""The known types of a life as recognition reads them: alike ones joined, where they were, what policies earn."""

from collections import Counter
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.any_tasks.experience import Experience
from lifelore.agent.any_tasks.known_moves import KnownMoves
from lifelore.agent.any_tasks.moves import Counts
from lifelore.agent.types.same_type import JoinedType
from lifelore.agent.types.type_prior import TypePrior
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes

Array = NDArray[np.float64]

LEAST_DEVIATION = 1e-3
"""Least deviation of returns, as a share of the largest size of a mean."""
GUESS = 1.0
"""Number of returns that a guess counts as."""


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

    def type_prior(self) -> TypePrior:
        """Which of these types to expect, by context and date."""
        types = self.experience.types
        return TypePrior.of_types([[types[name].sightings for name in one.members] for one in self.types])


def known_returns(
    experience: Experience, types: Sequence[Sequence[str]], policies: Sequence[str]
) -> GaussianOutcomes:
    """Normal returns of each policy on each type.

    A pair that never ran is guessed as the policy's mean on other types, but at most as the least mean of the
    type's own policies: a policy that was learnt for another type is hardly better. All pairs share one deviation.

    Parameters
    ----------
    experience : Experience
    types : sequence of sequences of str
        The members of each type, by name.
    policies : sequence of str
    """
    sums = np.array([[_sums(experience, members, policy) for policy in policies] for members in types])
    number, total, squares = np.moveaxis(sums, -1, 0)
    ran = number > 0
    mean = np.divide(total, number, out=np.zeros_like(total), where=ran)
    within = np.maximum(squares - number * mean**2, 0.0).sum() / max(number.sum() - ran.sum(), 1.0)
    scale = np.abs(mean[ran]).max(initial=1e-6)
    own = np.array([[policy in members for policy in policies] for members in types])
    elsewhere, at_home = np.ma.array(mean, mask=~(ran & ~own)), np.ma.array(mean, mask=~(ran & own))
    usual = elsewhere.mean(axis=0).filled(elsewhere.mean() if elsewhere.count() else 0.0)
    least = at_home.min(axis=1).filled(at_home.min() if at_home.count() else 0.0)
    guess = np.minimum(usual[None], least[:, None])
    number = np.where(ran, number, GUESS)
    return GaussianOutcomes(np.where(ran, mean, guess), max(np.sqrt(within), LEAST_DEVIATION * scale), number)


def _sums(experience: Experience, members: Sequence[str], policy: str) -> Array:
    rows = (experience.types[name].returns.get(policy) for name in members)
    return sum((row for row in rows if row is not None), start=np.zeros(3))
