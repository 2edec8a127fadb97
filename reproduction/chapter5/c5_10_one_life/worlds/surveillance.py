"""The surveillance reserve of the thesis (§4.6.4) as patrols: intruders prefer a hidden place.

A patrol is some deployments of a drone. The intruders are mostly at the place that they prefer, else elsewhere
around the same hill.
"""

from functools import cache
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Discrete

from lifelore.core.streams import stream
from lifelore.domains.surveillance.surveillance import HILLS, REACH, Surveillance
from reproduction.chapter5.c5_10_one_life.worlds.family import Family

TYPES = ("first gang", "second gang", "third gang", "fourth gang")
DEPLOYMENTS = 8
LOYAL = 0.8
"""Probability that intruders are at the preferred place in a deployment."""
REPORT = 50.0
"""Unit of what is reported and paid; the thesis's noise has a deviation of 20."""
CLASSES = 5
"""Classes of the last pay: none yet, a loss, about nothing, something, much (from 150)."""


@cache
def _reserve() -> tuple[Surveillance, Any]:
    """The reserve, and the numbers of the targets in use: hilltops, and the outer ends of the arms around."""
    reserve = Surveillance()
    apart = np.abs(reserve.targets - np.array(HILLS).repeat(reserve.n_targets // len(HILLS), axis=0)).max(axis=1)
    return reserve, np.flatnonzero(reserve.is_hilltop | (apart == REACH)).reshape(len(HILLS), -1)


class Patrol(gymnasium.Env):
    """Deployments of a drone while intruders come back to a place that they prefer.

    ## Action Space
    ``Discrete(20)``: four hilltops with the four outer targets around each.

    ## Observation Space
    ``Discrete(5)``: the class of what the last deployment paid, see `CLASSES`.

    ## Rewards
    The pay of the thesis, in units of `REPORT`, rounded.

    ## Arguments
    `hill`, `place`: number of the preferred hill, and of the outer target there, from 1.
    """

    def __init__(self, hill: int, place: int) -> None:
        self.reserve, self.targets = _reserve()
        self.hill, self.place = hill, place
        self.action_space = Discrete(self.targets.size)
        self.observation_space = Discrete(CLASSES)
        self._left = 0

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None):
        """Begin a patrol."""
        super().reset(seed=seed)
        self._left = DEPLOYMENTS
        return 0, {}

    def step(self, action: Any):
        """Fly to a target."""
        place = self.place
        if self.np_random.random() >= LOYAL:
            place = int(self.np_random.integers(self.targets.shape[1]))
        intruders = self.reserve.targets[self.targets[self.hill, place]]
        pay = float(self.reserve.sample(self.np_random, intruders, self.targets.flat[int(action)]))
        paid = float(round(pay / REPORT))
        self._left -= 1
        return class_of(paid), paid, self._left == 0, False, {}


def class_of(paid: float) -> int:
    """The class of a pay in units of `REPORT`."""
    return 1 if paid < 0 else 2 if paid < 1 else 3 if paid < 3 else 4


def make(gang: str, seed: int) -> Patrol:
    """The patrol of a life: each gang prefers another place."""
    n_hills, n_places = len(HILLS), 4
    drawn = stream(seed, "C5.10", "gangs").permutation(n_hills * n_places)[TYPES.index(gang)]
    return Patrol(int(drawn) // n_places, 1 + int(drawn) % n_places)


SURVEILLANCE = Family(TYPES, make, int, int, max_steps=DEPLOYMENTS)
