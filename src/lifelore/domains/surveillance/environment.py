"""The surveillance reserve as a Gymnasium environment; `lifelore.domains` registers it."""

from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.domains.checked_environment import CheckedEnvironment
from lifelore.domains.surveillance.surveillance import SIDE, Surveillance

LARGEST = 10_000.0
"""Bound of what is observed, far beyond any pay."""


class SurveillanceEnvironment(CheckedEnvironment):
    """The thesis's surveillance domain (§4.6.4): deployments of a drone until the poachers' place is known.

    ## Action Space
    ``Discrete(68)``: the target that the drone surveys.

    ## Observation Space
    ``Box(1,)``: what the last deployment paid, which is all it reports; 0 before the first.

    ## Rewards
    By the distance d to the poachers: 200 − 30 d from a hilltop if d ≤ 15, 200 − 20 d from another target if
    d ≤ 3, else 0, and noise of mean 10.

    ## Starting State
    Poachers at one of the targets, each as likely, for the whole episode; with `unseen` at any cell near a hill.
    ``reset(options={"poachers": (row, column)})`` chooses the cell.

    ## Episode End
    Never; truncated after 50 deployments.

    ## Arguments
    `layout`: ``"X"``, ``"diamond"``, ``"ring"`` or ``"checkerboard"``. `metric`: ``"chebyshev"`` or
    ``"euclidean"``. `deviation`: of the noise, 20. `unseen`: False.

    ``info["poachers"]`` is where they are, which the base station does not know.
    """

    def __init__(
        self, layout: str = "X", metric: str = "chebyshev", deviation: float = 20.0, unseen: bool = False
    ) -> None:
        super().__init__()
        self.world = Surveillance(layout, metric, deviation)
        self.unseen = unseen
        self.action_space = spaces.Discrete(self.world.n_targets)
        self.observation_space = spaces.Box(-LARGEST, LARGEST, (1,), np.float64)
        self.poachers = (0, 0)
        self._drone: int | None = None

    def _begin(self, options: dict[str, Any]) -> tuple[NDArray[np.float64], dict[str, Any]]:
        row, column = self.world.draw_cells(self.np_random, 1, seen=not self.unseen)[0].tolist()
        self.poachers = _checked(options.get("poachers", (row, column)))
        self._drone = None
        return np.zeros(1), {"poachers": self.poachers}

    def _advance(self, action: int) -> tuple[NDArray[np.float64], float, bool, dict[str, Any]]:
        self._drone = action
        pay = float(self.world.sample(self.np_random, self.poachers, action))
        return np.array([np.clip(pay, -LARGEST, LARGEST)]), pay, False, {"poachers": self.poachers}


def _checked(cell: Any) -> tuple[int, int]:
    place = np.asarray(cell)
    if place.shape != (2,) or place.dtype.kind not in "iu" or place.min() < 0 or place.max() >= SIDE:
        raise InputError(f"options['poachers'] must be a row and a column in [0, {SIDE}), got {cell!r}")
    return int(place[0]), int(place[1])
