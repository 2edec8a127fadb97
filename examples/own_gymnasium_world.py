"""An agent lives through fifteen FrozenLake maps and carries an action prior from map to map.

For reinforcement-learning researchers. The agent learns each task over `state`, and the prior over `context`.
"""

import gymnasium as gym
import numpy as np
from gymnasium.envs.toy_text.frozen_lake import generate_random_map

from lifelore import GymnasiumWorld, live_in


def lake(task: int) -> gym.Env:
    """Another map for each task; the robot observes its place and the nine tiles around it."""
    env = gym.make("FrozenLake-v1", desc=generate_random_map(6, seed=task), is_slippery=False)
    tiles = np.pad(env.unwrapped.desc, 1)

    def look(place: int) -> tuple[int, bytes]:
        return place, tiles[place // 6 :, place % 6 :][:3, :3].tobytes()

    return gym.wrappers.TransformObservation(env, look, None)


world = GymnasiumWorld(lake, state=lambda seen: seen[0], context=lambda seen: seen[1])
report = live_in(world, tasks=15, episodes=500, epsilon_decay=0.995)
jumpstart = report["summary"]["lore_vs_scratch"]["jumpstart"]
print(
    f"return of the first episode, gain over scratch: {jumpstart['value']:.2f}, 95 % interval {jumpstart['ci95']}"
)
