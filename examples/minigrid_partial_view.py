"""An agent lives through MiniGrid's rooms with doors, of which it sees seven by seven cells.

For reinforcement-learning researchers. The view is no state: many places look alike. So each task is learnt over
the pose and the cells beside it (`state`), and the prior over the cells beside alone (`context`).
"""

import gymnasium as gym
from minigrid.wrappers import ImgObsWrapper

from lifelore import GymnasiumWorld, live_in

env = gym.wrappers.FlattenObservation(ImgObsWrapper(gym.make("MiniGrid-MultiRoom-N2-S4-v0")))


def beside(seen) -> tuple[int, ...]:
    """Kind and state of the cells to the left, in front and to the right; the agent is at (3, 6) of its view."""
    return tuple(seen.reshape(7, 7, 3)[[2, 3, 4], [6, 5, 6]][:, [0, 2]].ravel().tolist())


def pose(seen) -> tuple[int, ...]:
    """Column, row and direction of the agent, which the view does not show, and whether a door beside is open."""
    column, row = env.unwrapped.agent_pos
    return int(column), int(row), int(env.unwrapped.agent_dir), *beside(seen)


world = GymnasiumWorld(env, state=pose, context=beside)
report = live_in(world, tasks=6, episodes=100, max_steps=40)
gain = report["summary"]["lore_vs_scratch"]["mean_return_difference"]
print(f"mean return of the last tasks: gain over scratch {gain['value']:.2f}, lore {gain['raw']['lore']:.2f}")
