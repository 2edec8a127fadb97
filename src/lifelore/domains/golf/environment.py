"""Golf as a Gymnasium environment; `lifelore.domains` registers it."""

from typing import Any

import numpy as np
from gymnasium import spaces

from lifelore.core.errors import InputError
from lifelore.domains.checked_environment import CheckedEnvironment
from lifelore.domains.golf.golf import CATEGORIES, Golf, category_of

LONGEST = 1000.0
"""Longest hole that may be asked for, yards."""


class GolfEnvironment(CheckedEnvironment):
    """The thesis's golf club selection (§4.6.1): shots from one tee at a hole of unknown distance.

    ## Action Space
    ``Discrete(4)``: 3-wood, 3-iron, 6-iron, 9-iron.

    ## Observation Space
    ``Discrete(8)``: the category of the last shot's error, from far too short (0) to far too long (6); 7 before
    the first shot.

    ## Rewards
    Minus the distance between ball and hole, in yards.

    ## Starting State
    A hole between 120 and 220 yards away, each distance as likely; ``reset(options={"distance": y})`` chooses it.

    ## Episode End
    Never; truncated after 3 shots.

    ## Arguments
    `distance`: of every hole in yards, None draws it anew at each reset.

    ``info`` has ``"distance"``, and after a shot ``"error"``, yards beyond the hole: the golfer knows neither.
    """

    def __init__(self, distance: float | None = None) -> None:
        super().__init__()
        self.world = Golf()
        self._fixed = None if distance is None else _checked(distance)
        self.action_space = spaces.Discrete(self.world.n_clubs)
        self.observation_space = spaces.Discrete(len(CATEGORIES) + 1)
        self.distance = 0.0
        self.landed: list[float] = []

    def _begin(self, options: dict[str, Any]) -> tuple[int, dict[str, Any]]:
        drawn = float(self.world.draw_holes(self.np_random, 1)[0])
        asked = options.get("distance", self._fixed)
        self.distance = drawn if asked is None else _checked(asked)
        self.landed = []
        return len(CATEGORIES), {"distance": self.distance}

    def _advance(self, action: int) -> tuple[int, float, bool, dict[str, Any]]:
        error = float(self.world.sample_errors(self.np_random, self.distance, action))
        self.landed.append(self.distance + error)
        return int(category_of(error)), -abs(error), False, {"distance": self.distance, "error": error}


def _checked(distance: Any) -> float:
    number = isinstance(distance, (int, float, np.number)) and not isinstance(distance, bool)
    if not number or not 0 < distance <= LONGEST:
        raise InputError(f"distance must be yards in (0, {LONGEST:g}], got {distance!r}")
    return float(distance)
