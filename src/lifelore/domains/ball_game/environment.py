"""The ball game as a Gymnasium environment; `lifelore.domains` registers it."""

from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.domains.ball_game.ball_game import (
    HEADINGS,
    SIDE,
    SIGMA_RANGE,
    LossScale,
    ball_game,
    check_place,
    step,
)
from lifelore.domains.ball_game.simulated_player import choose_heading
from lifelore.domains.checked_environment import CheckedEnvironment

ROLES = ("player", "interface")


class BallGameEnvironment(CheckedEnvironment):
    """The thesis's ball game (§4.8.5.1): a ball is steered to a goal, at a speed that an interface sets.

    ## Action Space
    As player ``Discrete(4)``: north, south, east, west. As interface ``Discrete(5)``: the number of the speed for
    the next step; the simulated player steers.

    ## Observation Space
    ``Box(0, 1000, (2,), int64)``: the place (x, y) of the ball's centre, y downwards.

    ## Rewards
    Minus the loss when the goal is reached, steps / 400 + collisions / 20; else 0.

    ## Starting State
    The layout's start; ``reset(options={"place": (x, y)})`` starts elsewhere, ``{"sigma": s}`` fixes the noise of
    the episode, which is else drawn from [0.3, 8].

    ## Episode End
    The ball's centre comes into the goal; truncated after 400 steps.

    ## Arguments
    `layout`: a name, ``"s-maze 160"``. `size`: of the ball, one of 2, 5, 10, 20, 40, 60. `speed`: in force at the
    start, one of 30, 40, 50, 60, 70; `set_speed` changes it. `role`: ``"player"`` or ``"interface"``.
    `radius_share`: radius of the ball as a share of its size, 0.5. `blocked`: a ball whose move would touch an
    obstacle ``"slides"`` up to it, or ``"stays"`` where it is. `scale`: a `LossScale`.

    ``info`` has ``"collision"``, ``"speed"`` in force, the ``"heading"`` commanded last, or None, and ``"sigma"``.
    """

    def __init__(
        self,
        layout: str = "s-maze 160",
        size: int = 20,
        speed: int = 50,
        role: str = "player",
        radius_share: float = 0.5,
        blocked: str = "slides",
        scale: LossScale | None = None,
    ) -> None:
        super().__init__()
        if role not in ROLES:
            raise InputError(f"role must be one of {', '.join(ROLES)}, got {role!r}")
        self.role = role
        self.game = ball_game(layout, radius_share, blocked=blocked)
        self.kind = _number(self.game.sizes, size, "size")
        self.scale = scale or LossScale()
        self.set_speed(speed)
        n_actions = len(HEADINGS) if role == "player" else self.game.n_speeds
        self.action_space = spaces.Discrete(n_actions)
        self.observation_space = spaces.Box(0, SIDE, (2,), np.int64)
        self._place: tuple[int, int] = self.game.layout.start

    def set_speed(self, speed: int) -> None:
        """Put another speed in force, from the next step on."""
        self._speed = _number(self.game.speeds, speed, "speed")

    def _begin(self, options: dict[str, Any]) -> tuple[NDArray[np.int64], dict[str, Any]]:
        drawn = float(self.np_random.uniform(*SIGMA_RANGE))
        self._sigma = float(options.get("sigma", drawn))
        if not 0 <= self._sigma < np.inf:
            raise InputError(f"options['sigma'] must be finite and at least 0, got {self._sigma}")
        x, y = options.get("place", self.game.layout.start)
        check_place(self.game, self.kind, int(x), int(y))
        self._place = (int(x), int(y))
        self._steps = self._hits = 0
        return self._observation(), self._info(False, None)

    def _advance(self, action: int) -> tuple[NDArray[np.int64], float, bool, dict[str, Any]]:
        field, heading = self.game.field, action
        if self.role == "interface":
            self._speed = action
            heading = choose_heading(field, self.kind, *self._place, field.speeds[self._speed])
        x, y, hit, reached = step(
            field,
            self.kind,
            *self._place,
            heading,
            field.speeds[self._speed],
            self._sigma,
            *self.np_random.random(3),
        )
        self._place = (int(x), int(y))
        self._steps += 1
        self._hits += bool(hit)
        reward = -float(self.scale.loss(self._steps, self._hits)) if reached else 0.0
        return self._observation(), reward, bool(reached), self._info(bool(hit), HEADINGS[heading])

    def _observation(self) -> NDArray[np.int64]:
        return np.array(self._place, np.int64)

    def _info(self, hit: bool, heading: str | None) -> dict[str, Any]:
        speed = self.game.speeds[self._speed]
        return {"collision": hit, "speed": speed, "heading": heading, "sigma": self._sigma}


def _number(known: tuple[int, ...], value: int, what: str) -> int:
    if value not in known:
        raise InputError(f"{what} must be one of {', '.join(map(str, known))}, got {value!r}")
    return known.index(value)
