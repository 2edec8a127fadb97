"""Your own agent lives beside Lifelore's, on the same tasks and episodes, and stands in the same report.

For reinforcement-learning researchers. Here it is Sarsa, which forgets everything after each task.
"""

from collections import defaultdict

import gymnasium as gym
import numpy as np

from lifelore import GymnasiumWorld, live_in


def sarsa(world, task: int, seeds: list[int], max_steps: int) -> None:
    """Learn one task, an episode a seed; the world that it gets observes the returns."""
    random, q = np.random.default_rng(task), defaultdict(lambda: np.zeros(world.n_actions))

    def act(state) -> int:
        ties = np.flatnonzero(q[state] == q[state].max())
        return int(random.integers(world.n_actions) if random.random() < 0.1 else random.choice(ties))

    for seed in seeds:
        state = world.reset(task, seed)
        action = act(state)
        for _ in range(max_steps):
            following, reward, terminated, truncated = world.step(action)
            chosen = act(following)
            q[state][action] += 0.5 * (reward + 0.95 * (not terminated) * q[following][chosen] - q[state][action])
            state, action = following, chosen
            if terminated or truncated:
                break


world = GymnasiumWorld(gym.make("Taxi-v4"))  # another passenger and destination in each task
report = live_in(world, tasks=12, episodes=100, max_steps=200, agents={"sarsa": sarsa})
print({name: round(own["last"]["mean_return"]["value"], 1) for name, own in report["summary"]["agents"].items()})
