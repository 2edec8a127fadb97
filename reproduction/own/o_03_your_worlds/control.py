"""Worlds of Gymnasium's classic control whose bodies differ by task, with observations in bins."""

from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium.wrappers import TransformObservation
from numpy.typing import NDArray

from lifelore.core.streams import stream

CART_BINS = ([-0.8, 0.8], [-0.5, 0.5], [-0.105, -0.0175, 0.0, 0.0175, 0.105], [-0.87, 0.87])
"""Limits of the bins of position (m), speed (m/s), angle (rad) and its speed (rad/s), after Barto and Sutton."""
ANGLES = [-2.0, -1.0, -0.3, 0.3, 1.0, 2.0]
SPEEDS = [-2.0, -0.5, 0.5, 2.0]
"""Limits of the bins of Acrobot's two angles (rad) and their speeds (rad/s)."""


def cart_pole(number: int) -> gymnasium.Env:
    """A cart and pole of random length, masses and force; observes the bins."""
    env = gymnasium.make("CartPole-v1")
    body: Any = env.unwrapped
    random = stream(number, "O3", "cart pole")
    body.length, body.masspole, body.force_mag = random.uniform((0.25, 0.05, 6.0), (1.5, 0.4, 14.0)).tolist()
    body.total_mass, body.polemass_length = body.masspole + body.masscart, body.masspole * body.length

    def look(seen: NDArray[np.float32]) -> tuple[int, ...]:
        return _bins(seen, CART_BINS)

    return TransformObservation(env, look, None)


def acrobot(number: int) -> gymnasium.Env:
    """An acrobot whose two links have random masses and lengths; observes the bins."""
    env = gymnasium.make("Acrobot-v1")
    body: Any = env.unwrapped
    sizes = stream(number, "O3", "acrobot").uniform((0.8, 0.8, 0.8, 0.8), (1.2, 1.2, 1.2, 1.2)).tolist()
    body.LINK_MASS_1, body.LINK_MASS_2, body.LINK_LENGTH_1, body.LINK_LENGTH_2 = sizes
    body.LINK_COM_POS_1, body.LINK_COM_POS_2 = body.LINK_LENGTH_1 / 2, body.LINK_LENGTH_2 / 2

    def look(seen: NDArray[np.float32]) -> tuple[int, ...]:
        cos_1, sin_1, cos_2, sin_2, speed_1, speed_2 = seen.tolist()
        angles = np.arctan2(sin_1, cos_1), np.arctan2(sin_2, cos_2)
        return _bins((*angles, speed_1, speed_2), (ANGLES, ANGLES, SPEEDS, SPEEDS))

    return TransformObservation(env, look, None)


def _bins(values: Sequence[float] | NDArray[np.float32], limits: Sequence[Sequence[float]]) -> tuple[int, ...]:
    """The number of each value's bin."""
    return tuple(int(np.searchsorted(own, value)) for own, value in zip(limits, values, strict=True))
