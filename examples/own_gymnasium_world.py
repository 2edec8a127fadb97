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
# Goals behind holes are hard to find, so both agents explore longer than by default.
report = live_in(world, tasks=15, episodes=500, epsilon_decay=0.995)
for other in ("scratch", "textbook"):
    gain = report["summary"][f"lore_vs_{other}"]["mean_return_difference"]
    low, high = gain["ci95"]
    print(f"mean return, gain over {other}: {gain['value']:.2f}, 95 % interval {low:.2f} to {high:.2f}")
