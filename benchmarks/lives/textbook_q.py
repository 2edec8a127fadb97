"""Textbook Q-learning (Sutton and Barto, §6.5) in twenty lines: a baseline that shares no code with Lifelore."""

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from lifelore.core.protocols import World


def textbook_q_returns(
    world: World,
    task: int,
    seeds: Sequence[int],
    max_steps: int,
    discount: float,
    step_size: float,
    random: np.random.Generator,
    epsilon: float = 0.1,
) -> list[float]:
    """Discounted return of each episode of one task; ε is constant, and ties are broken at random."""
    q, returns = defaultdict(lambda: np.zeros(world.n_actions)), []
    for seed in seeds:
        state, earned, factor = world.reset(task, seed), 0.0, 1.0
        for _ in range(max_steps):
            values = q[state]
            best = values if random.random() >= epsilon else np.zeros(world.n_actions)
            action = int(random.choice(np.flatnonzero(best == best.max())))
            following, reward, terminated, truncated = world.step(action)
            future = 0.0 if terminated else discount * q[following].max()
            values[action] += step_size * (reward + future - values[action])
            earned, factor, state = earned + factor * reward, factor * discount, following
            if terminated or truncated:
                break
        returns.append(earned)
    return returns
