"""CartPole of Gymnasium with a hidden length of the pole and a hidden force, observed in bins."""

from bisect import bisect
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import MultiDiscrete

from reproduction.chapter5.c5_10_one_life.worlds.family import Family, as_tuple

BINS = ([-0.8, 0.8], [-0.5, 0.5], [-0.105, -0.0175, 0.0, 0.0175, 0.105], [-0.87, 0.87])
"""Limits of the bins of position (m), speed (m/s), angle (rad) and its speed (rad/s).

Source: Barto, Sutton and Anderson (1983), with finer bins of small angles.
"""
BODIES = {"usual": (0.5, 10.0), "long, weak": (1.5, 5.0), "short, strong": (0.25, 20.0), "reversed": (0.5, -10.0)}
"""Half of the pole's length (m), and the force of a push to the right (N); Gymnasium's own come first."""
MAX_STEPS = 100


def make(body: str, seed: int) -> gymnasium.Env:
    """A cart and pole of a body; the same in every life. It observes the bins."""
    env = gymnasium.make("CartPole-v1", max_episode_steps=MAX_STEPS, disable_env_checker=True)
    base: Any = env.unwrapped
    base.length, base.force_mag = BODIES[body]
    base.polemass_length = base.masspole * base.length
    return gymnasium.wrappers.TransformObservation(env, _bins, MultiDiscrete([len(bins) + 1 for bins in BINS]))


def _bins(seen: Any) -> Any:
    return np.array([bisect(bins, value) for bins, value in zip(BINS, seen.tolist(), strict=True)], np.int64)


def features(observation: Any) -> tuple[int, ...]:
    """The bins of the angle and of its speed."""
    return tuple(observation[2:].tolist())


CART_POLE = Family(tuple(BODIES), make, as_tuple, features, max_steps=MAX_STEPS, discount=0.99, learner="model")
